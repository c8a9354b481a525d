// What the glTF validator finds in GLBs that a viewer would stumble over: node validate_glb.mjs GLB...
import {readFileSync} from "node:fs";
import validator from "gltf-validator";

for (const file of process.argv.slice(2)) {
  const {issues} = await validator.validateBytes(new Uint8Array(readFileSync(file)));
  // Texture coordinates without a texture are for the viewer's own.
  const messages = issues.messages.filter(({code}) => code !== "UNUSED_OBJECT");
  for (const {code, message, pointer} of messages) console.log(`${file}: ${code} at ${pointer}: ${message}`);
  if (messages.length > 0) process.exitCode = 1;
}
