// Shows openapi.json. Text only ever becomes text: nothing of the document is taken for markup.
"use strict";

function element(name, text, ...children) {
  const made = document.createElement(name);
  if (text) made.textContent = text;
  made.append(...children);
  return made;
}

function resolve(contract, node) {
  while (node.$ref) node = node.$ref.slice(2).split("/").reduce((at, step) => at[step], contract);
  return node;
}

function examples(content) {
  const shown = [];
  for (const [type, media] of Object.entries(content || {})) {
    for (const [name, example] of Object.entries(media.examples || {})) {
      shown.push(element("div", `${type}, ${name}`), element("pre", JSON.stringify(example.value, null, 1)));
    }
  }
  return shown;
}

function operation(contract, method, path, described) {
  const body = element("div", described.description);
  const rows = [];
  for (const parameter of described.parameters || []) {
    const p = resolve(contract, parameter);
    rows.push(element("tr", "", element("td", p.name), element("td", p.in), element("td", p.description)));
  }
  if (rows.length) body.append(element("h4", "Parameters"), element("table", "", ...rows));
  const answers = Object.entries(described.responses).map(([status, answer]) => {
    const a = resolve(contract, answer);
    return element("tr", "", element("td", status), element("td", a.description));
  });
  body.append(element("h4", "Answers"), element("table", "", ...answers));
  for (const answer of Object.values(described.responses)) body.append(...examples(resolve(contract, answer).content));
  const summary = element("summary", "", element("b", method.toUpperCase()), element("code", path), ` ${described.summary || ""}`);
  return element("details", "", summary, body);
}

async function show() {
  const place = document.getElementById("contract");
  try {
    const contract = await (await fetch("/openapi.json")).json();
    place.replaceChildren(element("p", contract.info.description));
    for (const [path, item] of Object.entries(contract.paths)) {
      for (const method of ["get", "post", "put", "delete"]) {
        if (item[method]) place.append(operation(contract, method, path, item[method]));
      }
    }
    place.append(element("h2", "Schemas"));
    for (const [name, schema] of Object.entries(contract.components.schemas)) {
      place.append(element("details", "", element("summary", name), element("pre", JSON.stringify(schema, null, 1))));
    }
  } catch (error) {
    place.textContent = `The contract could not be read: ${error.message}`;
  }
}

show();
