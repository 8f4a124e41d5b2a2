// MaterialX' own library (the WASM build of an npm package) on documents: validates each, generates its GLSL ES shader.
//   node materialx.mjs PACKAGE_FOLDER OUT_FOLDER FILE...
// One line a file: its name, "valid" or "invalid", the name of the surface; OUT_FOLDER/NAME.frag is the pixel shader.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const [folder, out, ...files] = process.argv.slice(2);
const bin = path.resolve(folder, 'bin');
// The package's script is written for browsers and for CommonJS.
globalThis.require = createRequire(import.meta.url);
globalThis.__dirname = bin;
const load = (await import(pathToFileURL(path.join(bin, 'JsMaterialXGenShader.js')).href)).default;
const data = fs.readFileSync(path.join(bin, 'JsMaterialXGenShader.data.txt'));
const mx = await load({
  wasmBinary: fs.readFileSync(path.join(bin, 'JsMaterialXGenShader.wasm')),
  getPreloadedPackage: () => data.buffer.slice(data.byteOffset, data.byteOffset + data.length),
  locateFile: (name) => path.join(bin, name),
});
const generator = mx.EsslShaderGenerator.create();
const context = new mx.GenContext(generator);
const library = mx.loadStandardLibraries(context);
console.log(`MaterialX ${mx.getVersionString()}`);
for (const file of files) {
  const document = mx.createDocument();
  document.importLibrary(library);
  await mx.readFromXmlString(document, fs.readFileSync(file, 'utf8'), '');
  const valid = document.validate();
  const surface = mx.findRenderableElement(document);
  const shader = generator.generate(surface.getNamePath(), surface, context);
  fs.writeFileSync(path.join(out, `${path.basename(file)}.frag`), shader.getSourceCode('pixel'));
  console.log(`${path.basename(file)} ${valid ? 'valid' : 'invalid'} ${surface.getNamePath()}`);
}
