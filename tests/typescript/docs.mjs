// The page that shows the contract, as a browser makes it: node docs.mjs URL
import assert from "node:assert/strict";
import vm from "node:vm";
import {parseHTML} from "linkedom";

const [url] = process.argv.slice(2);
const text = async (path) => (await fetch(url + path)).text();
const contract = JSON.parse(await text("/openapi.json"));
const {document} = parseHTML(await text("/docs"));
const place = document.getElementById("contract");
vm.runInNewContext(await text("/docs/docs.js"), {
  document, location: {hash: "#createJob"}, decodeURIComponent, addEventListener: () => undefined,
  fetch: (path) => fetch(url + path),
});
for (let tries = 0; !document.getElementById("schema-Job") && tries < 200; ++tries) await new Promise((done) => setTimeout(done, 50));
assert(!place.textContent.includes("could not be read"), place.textContent);

const plain = (described) => described.replaceAll("`", "");
const resolve = (node) => (node?.$ref ? resolve(node.$ref.slice(2).split("/").reduce((at, step) => at[step], contract)) : node);
let operations = 0, examples = 0;
for (const item of Object.values(contract.paths)) {
  for (const method of ["get", "post", "put", "delete"].filter((name) => item[name])) {
    const described = item[method];
    const shown = document.getElementById(described.operationId);
    assert(shown, `${described.operationId} is not shown`);
    ++operations;
    for (const [status, answer] of Object.entries(described.responses)) {
      const row = [...shown.querySelectorAll("tr")].find((tr) => tr.firstElementChild.textContent === status);
      assert.equal(row?.lastElementChild.textContent, plain(resolve(answer).description), `${described.operationId}: ${status}`);
    }
    for (const type of Object.keys(resolve(described.requestBody)?.content ?? {})) {
      assert([...shown.querySelectorAll("h5")].some((h5) => h5.textContent.startsWith(type)), `${described.operationId}: ${type}`);
    }
    for (const parameter of described.parameters ?? []) assert(shown.textContent.includes(resolve(parameter).name));
    examples += [...shown.querySelectorAll("summary")].filter((summary) => summary.textContent.startsWith("Example")).length;
  }
}
for (const name of Object.keys(contract.components.schemas)) assert(document.getElementById(`schema-${name}`), name);
for (const link of document.querySelectorAll("#contract a")) {
  assert(document.getElementById(link.getAttribute("href").slice(1)), `${link.getAttribute("href")} leads nowhere`);
}
assert(document.getElementById("browser"));
assert(examples > 10, `${examples} examples`);
console.log(operations, "operations");
