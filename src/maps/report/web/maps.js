// The live part of a page of maps: the picture under a light that is dragged.
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id);
const rad = Math.PI / 180;
const canvas = $('relit'), gl = canvas.getContext('webgl2', {alpha: true, premultipliedAlpha: false});
let failure = '', uniforms = {}, light = [0, 0, 1], distance = 0, photograph = 0;

// ---- the maps as textures of half precision ----
function halves(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Uint16Array(bytes.buffer);
}
function compile(type, text) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) failure += gl.getShaderInfoLog(shader);
  return shader;
}
function prepare() {
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER, '#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }'));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, $('shader').textContent));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) { failure += gl.getProgramInfoLog(program); return; }
  gl.useProgram(program);
  ['normals', 'diffuses', 'mirrors', 'lasts'].forEach((name, unit) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, data.width, data.height, 0, gl.RGBA, gl.HALF_FLOAT, halves(data[name]));
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    gl.uniform1i(gl.getUniformLocation(program, name), unit);
  });
  for (const name of ['light', 'camera', 'grid', 'fall', 'schlick', 'exposure']) uniforms[name] = gl.getUniformLocation(program, name);
  gl.uniform1f(uniforms.schlick, data.schlick ? 1 : 0);
  gl.uniform4fv(uniforms.grid, data.grid);
  gl.uniform2fv(uniforms.fall, data.near ? data.near.fall : [0, 0]);
}
function render() {
  if (!gl || failure) return;
  gl.viewport(0, 0, data.width, data.height);
  gl.uniform4fv(uniforms.light, data.near ? [...light.map(x => x * distance), 1] : [...light, 0]);
  const cameras = data.cameras;
  gl.uniform4fv(uniforms.camera, cameras.length ? [...cameras[cameras.length > 1 ? photograph : 0], 1] : [0, 0, 1, 0]);
  gl.uniform1f(uniforms.exposure, data.exposure * Math.pow(2, Number($('exposure').value)));
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// ---- the light ----
function setLight(v, chosen) {
  const length = Math.hypot(...v);
  light = v.map(x => x / length);
  if (chosen !== undefined) photograph = chosen;
  // A light that is dragged stays as far as the lights are on average.
  if (data.near) distance = chosen === undefined ? data.near.reference : data.near.distances[chosen];
  $('lightX').value = Math.round(Math.atan2(light[0], light[2]) / rad);
  $('lightY').value = Math.round(Math.asin(Math.max(-1, Math.min(1, light[1]))) / rad);
  for (const id of ['lightX', 'lightY']) $(id).setAttribute('aria-valuetext', $(id).value + ' degrees');
  $('lights').value = chosen === undefined ? '' : String(chosen);
  render();
}
function lightFromSliders() {
  const x = $('lightX').value * rad, y = $('lightY').value * rad;
  setLight([Math.sin(x) * Math.cos(y), Math.sin(y), Math.cos(x) * Math.cos(y)]);
}
// The picture is taken for a hemisphere: its middle is a light from the camera, its edge a grazing one.
function moveLight(e) {
  const box = canvas.getBoundingClientRect(), half = Math.min(box.width, box.height) / 2;
  let x = (e.clientX - box.left - box.width / 2) / half, y = (box.top + box.height / 2 - e.clientY) / half;
  const r = Math.hypot(x, y), most = 0.985;
  if (r > most) { x *= most / r; y *= most / r; }
  setLight([x, y, Math.sqrt(1 - x * x - y * y)]);
}

canvas.width = data.width;
canvas.height = data.height;
data.lights.forEach((v, index) => {
  const option = document.createElement('option');
  option.value = String(index);
  option.textContent = 'photograph ' + (index + 1);
  $('lights').append(option);
});
if (gl) {
  prepare();
  canvas.addEventListener('pointerdown', e => { canvas.setPointerCapture(e.pointerId); moveLight(e); });
  canvas.addEventListener('pointermove', e => { if (e.buttons) moveLight(e); });
  for (const id of ['lightX', 'lightY']) $(id).addEventListener('input', lightFromSliders);
  $('lights').addEventListener('change', () => { if ($('lights').value !== '') setLight(data.lights[Number($('lights').value)], Number($('lights').value)); });
  $('exposure').addEventListener('input', render);
  setLight(data.lights[data.first], data.first);
}
if (!gl || failure) {
  $('relitSection').classList.add('hidden');
  $('noGl').classList.remove('hidden');
}
