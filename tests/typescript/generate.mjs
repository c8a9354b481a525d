// The types of the contract, as a client generates them: bytes of a form are a Blob.
import {readFileSync, writeFileSync} from "node:fs";
import openapiTS, {astToString} from "openapi-typescript";
import ts from "typescript";

const [from, to] = process.argv.slice(2);
const blob = ts.factory.createTypeReferenceNode("Blob");
const types = await openapiTS(readFileSync(from, "utf8"), {
  transform: (schema) => (schema.format === "binary" ? blob : undefined),
});
writeFileSync(to, astToString(types));
