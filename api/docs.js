// Shows openapi.json. Text only ever becomes text: nothing of the document is taken for markup, but for `code`.
"use strict";

const methods = ["get", "post", "put", "delete"];  // HEAD and OPTIONS go with them

function element(name, content, ...children) {
  const made = document.createElement(name);
  if (content) made.append(...inline(content));
  made.append(...children.filter(Boolean));
  return made;
}

/** What stands between backticks is code. */
function inline(text) {
  return text.split("`").map((part, i) => {
    if (i % 2 === 0) return part;
    const code = document.createElement("code");
    code.textContent = part;
    return code;
  });
}

/** A description's paragraphs. */
function prose(text) {
  return (text || "").split(/\n{2,}|\n(?=\d+\. )/).filter(Boolean).map((paragraph) => element("p", paragraph));
}

function pre(text) {
  const made = document.createElement("pre");
  made.textContent = text;
  return made;
}

function link(text, target) {
  const made = document.createElement("a");
  made.textContent = text;
  made.href = target;
  return made;
}

function json(value) {
  return typeof value === "string" ? value : JSON.stringify(value, null, 1);
}

function resolve(contract, node) {
  while (node && node.$ref) node = node.$ref.slice(2).split("/").reduce((at, step) => at[step.replace(/~1/g, "/")], contract);
  return node;
}

/** Of which type a value is, with links to the schemas that it names. */
function typeOf(schema) {
  if (schema.$ref) {
    const name = schema.$ref.split("/").pop();
    return [link(name, `#schema-${name}`)];
  }
  const choices = schema.oneOf || schema.anyOf || schema.allOf;
  if (choices) return choices.flatMap((choice, i) => (i > 0 ? [" or ", ...typeOf(choice)] : typeOf(choice)));
  if (schema.type === "array") return ["list of ", ...typeOf(schema.items || {})];
  if (schema.const !== undefined) return [json(schema.const)];
  if (schema.enum) return [schema.enum.map(json).join(", ")];
  return [[schema.type || "anything"].flat().join(" or ")];
}

/** The fields of an object, one a row. */
function fields(schema) {
  const needed = schema.required || [];
  const rows = Object.entries(schema.properties || {}).map(([name, field]) =>
    element("tr", "", element("td", `\`${name}\`${needed.includes(name) ? "" : " (optional)"}`),
            element("td", "", ...typeOf(field)), element("td", field.description)));
  return rows.length > 0 ? element("table", "", ...rows) : "";
}

function example(title, value) {
  return element("details", "", element("summary", title), pre(json(value)));
}

/** A body of one media type: what it is, its fields, what it may look like. */
function media(contract, type, described) {
  const schema = resolve(contract, described.schema || {});
  const own = Object.entries(described.examples || {}).map(([name, shown]) => [shown.summary || name, resolve(contract, shown).value]);
  const shown = own.length > 0 ? own : (schema.examples || []).map((value, i) => [`${i + 1}`, value]);
  return element("section", "", element("h5", `\`${type}\` `, ...typeOf(described.schema || {})), ...prose(schema.description),
                 fields(schema), ...shown.map(([name, value]) => example(`Example: ${name}`, value)));
}

function bodyOf(contract, described) {
  if (!described.requestBody) return [];
  const body = resolve(contract, described.requestBody);
  return [element("h4", "Body"), ...prose(body.description),
          ...Object.entries(body.content).map(([type, content]) => media(contract, type, content))];
}

function parametersOf(contract, described) {
  const rows = (described.parameters || []).map((parameter) => {
    const p = resolve(contract, parameter);
    return element("tr", "", element("td", `\`${p.name}\`${p.required ? "" : " (optional)"}`), element("td", p.in), element("td", p.description));
  });
  return rows.length > 0 ? [element("h4", "Parameters"), element("table", "", ...rows)] : [];
}

function answersOf(contract, described) {
  const answers = Object.entries(described.responses).map(([status, answer]) => [status, resolve(contract, answer)]);
  const rows = answers.map(([status, answer]) => element("tr", "", element("td", status), element("td", answer.description)));
  const bodies = answers.filter(([status]) => status < 300).flatMap(([status, answer]) =>
    Object.entries(answer.content || {}).map(([type, content]) =>
      element("details", "", element("summary", `Body of ${status}, \`${type}\``), media(contract, type, content))));
  return [element("h4", "Answers"), element("table", "", ...rows), ...bodies];
}

function operation(contract, method, path, described) {
  const summary = element("summary", "", element("b", method.toUpperCase()), element("code", path), ` ${described.summary || ""}`);
  const made = element("details", "", summary,
                       element("div", "", ...prose(described.description), ...parametersOf(contract, described),
                               ...bodyOf(contract, described), ...answersOf(contract, described)));
  made.id = described.operationId || path;
  return made;
}

function operationsOf(contract, tag) {
  return Object.entries(contract.paths).flatMap(([path, item]) =>
    methods.filter((method) => item[method] && (item[method].tags || [])[0] === tag)
      .map((method) => operation(contract, method, path, item[method])));
}

function schemaOf(contract, name, schema) {
  const made = element("details", "", element("summary", `\`${name}\``),
                       element("div", "", ...prose(schema.description), schema.properties ? fields(schema) : element("p", "", ...typeOf(schema)),
                               ...(schema.examples || []).map((value, i) => example(`Example ${i + 1}`, value)),
                               example("As JSON Schema", schema)));
  made.id = `schema-${name}`;
  return made;
}

/** Whoever follows a link to something that is folded sees it. */
function unfold() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target || !("open" in target)) return;
  target.open = true;
  target.scrollIntoView();
}

async function show() {
  const place = document.getElementById("contract");
  try {
    const contract = await (await fetch("/openapi.json")).json();
    place.replaceChildren(...prose(contract.info.description));
    for (const {name, description} of contract.tags) {
      place.append(element("h2", name), ...prose(description), ...operationsOf(contract, name));
    }
    place.append(element("h2", "Webhook messages"));
    for (const [name, item] of Object.entries(contract.webhooks || {})) place.append(operation(contract, "post", name, item.post));
    place.append(element("h2", "Schemas"));
    for (const [name, schema] of Object.entries(contract.components.schemas)) place.append(schemaOf(contract, name, schema));
    unfold();
  } catch (error) {
    place.textContent = `The contract could not be read: ${error.message}`;
  }
}

addEventListener("hashchange", unfold);
show();
