// MaterialX' own library (the WASM build of an npm package) on documents: validates each, generates its GLSL ES shaders
// under one directional light. An environment is 0 unless its uniforms are set.
//   node materialx.mjs PACKAGE_FOLDER OUT_FOLDER FILE...
// One line a file: its name, "valid" or "invalid", the name of the surface. OUT_FOLDER/NAME.vert and .frag are the shaders,
// NAME.uniforms has the document's numbers, a line each: type, name, value.
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
const options = context.getOptions();
// The library cannot do without one here: transmission asks for a uniform that only environments bring.
options.hwSpecularEnvironmentMethod = mx.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_PREFILTER;
mx.HwShaderGenerator.bindLightShader(library.getNodeDef('ND_directional_light'), 1, context);
// GLSL ES has no values of uniforms.
const valuesOf = (shader) => {
  const block = shader.getStage('pixel').getUniformBlocks().PublicUniforms;
  return Array.from({ length: block.size() }, (_, k) => block.get(k))
    .filter((port) => port.getValue() !== null)
    .map((port) => `${port.getType().getName()} ${port.getVariable()} ${port.getValue().getValueString().replaceAll(',', ' ')}\n`)
    .join('');
};
console.log(`MaterialX ${mx.getVersionString()}`);
for (const file of files) {
  const document = mx.createDocument();
  document.importLibrary(library);
  await mx.readFromXmlString(document, fs.readFileSync(file, 'utf8'), '');
  const valid = document.validate();
  const surface = mx.findRenderableElement(document);
  const shader = generator.generate(surface.getNamePath(), surface, context);
  const stem = path.join(out, path.basename(file));
  for (const [stage, ending] of [['vertex', 'vert'], ['pixel', 'frag']]) {
    // Half floats, which Mesa takes for mediump, cannot hold the library's small numbers.
    fs.writeFileSync(`${stem}.${ending}`, shader.getSourceCode(stage).replaceAll('mediump', 'highp'));
  }
  fs.writeFileSync(`${stem}.uniforms`, valuesOf(shader));
  console.log(`${path.basename(file)} ${valid ? 'valid' : 'invalid'} ${surface.getNamePath()}`);
}
