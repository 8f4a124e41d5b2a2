// The live page of a report: sliders of the parameters, a slice with its measured values, and the spheres. Names in `data` come
// from measurement files: they become text nodes and nothing else.
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id);
const rad = Math.PI / 180;
const values = data.parameters.map(p => p.values.slice());

// ---- the shape of a lobe; all else of the model is evaluated by the shader, on the graphics card ----
const lobes = data.model.lobes;
function frameOf(k) {  // slope coordinates of lobe k from the ellipsoid: M = A^T A, Q^-1 = L L^T
  const v = i => values[lobes[k].first + i][0];
  const ax = v(0), ay = lobes[k].round ? ax : v(1);
  const tx = v(2) * rad, ty = v(3) * rad, tz = v(4) * rad;
  const [cx, sx, cy, sy, cz, sz] = [Math.cos(tx), Math.sin(tx), Math.cos(ty), Math.sin(ty), Math.cos(tz), Math.sin(tz)];
  const R = [[cy * cz, -cy * sz, sy], [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
             [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy]];
  const m = (i, j) => ax * ax * R[0][i] * R[0][j] + ay * ay * R[1][i] * R[1][j] + R[2][i] * R[2][j];
  const m33 = m(2, 2), x = -m(0, 2) / m33, y = -m(1, 2) / m33;
  // Q^-1 by cofactors: no subtraction of near equals.
  const s = (i, j) => ay * ay * R[0][i] * R[0][j] + ax * ax * R[1][i] * R[1][j] + ax * ax * ay * ay * R[2][i] * R[2][j];
  const q11 = s(1, 1) / (m33 * m33), q12 = -s(0, 1) / (m33 * m33), q22 = s(0, 0) / (m33 * m33);
  const a = Math.sqrt(q11), b = q12 / a, c = Math.sqrt(Math.max(1e-12, q22 - b * b));
  return {x, y, a, b, c};
}
// What the shader looks up of a radial profile: its density over GGX's in u = ln(1 + t), as cubics, and its M (the integral of
// masking) over GGX's in w = asinh(a), at nodes. M(a) = 2 / Z times the integral of f s (s - a atan(s / a)) over s, t = a^2 + s^2.
const GAUSS = (() => {
  const n = 12, rule = [];
  for (let i = 0; i < n; ++i) {
    let x = Math.cos(Math.PI * (i + 0.75) / (n + 0.5)), slope = 1;
    for (let k = 0; k < 50; ++k) {
      let p = 1, q = 0;
      for (let j = 1; j <= n; ++j) [p, q] = [((2 * j - 1) * x * p - (j - 1) * q) / j, p];
      slope = n * (x * p - q) / (x * x - 1);
      x -= p / slope;
    }
    rule.push([x, 2 / ((1 - x * x) * slope * slope)]);
  }
  return rule;
})();
function gauss(from, to, f) {
  const half = (to - from) / 2, center = from + half;
  return half * GAUSS.reduce((sum, [x, weight]) => sum + weight * f(center + half * x), 0);
}
const kernel = (s, a) => { const x = s / a; return x < 0.05 ? a * x * x * x * (1 / 3 - x * x * (1 / 5 - x * x / 7)) : s - a * Math.atan2(s, a); };
const NODE_STEP = 1 / 16, RATIO_END = 5;
function profileOf(k) {
  const lobe = lobes[k], own = i => values[lobe.first + 5 + i][0];
  let pieces = [], lnF, exponent, knots;
  if (lobe.spline) {
    const K = lobe.shapeParameters - 5;
    pieces = lobe.spline.left.map((left, i) => [left, lobe.spline.coefficients[i].map(row => row.reduce((sum, c, j) => sum + c * own(j), 0))]);
    exponent = 2 + own(K - 1);
    knots = lobe.spline.left.map(u => Math.sqrt(Math.expm1(u)));
    lnF = t => {
      const u = Math.log1p(t);
      let i = 0;
      while (i + 1 < pieces.length && u >= pieces[i + 1][0]) ++i;
      const x = u - pieces[i][0], c = pieces[i][1];
      return c[0] + x * (c[1] + x * (c[2] + x * c[3])) - 2 * u;
    };
  } else {
    exponent = own(0);
    knots = [0, 0.25, 0.5, 1, 2, 4, 8, 16, 32].map(r => r * Math.sqrt(exponent - 1));
    lnF = t => -exponent * Math.log1p(t / (exponent - 1));
  }
  const integral = a => {
    const ends = knots.filter(r => r > a).map(r => Math.sqrt((r - a) * (r + a))), last = Math.max(a, knots[knots.length - 1]);
    for (const factor of [2, 4]) ends.push(Math.sqrt((factor * last - a) * (factor * last + a)));
    for (let s = a; s > 0 && s < 0.7 * ends[0]; s *= 2) ends.unshift(s);
    ends.sort((x, y) => x - y);
    let sum = 0, from = 0;
    for (const to of ends) { sum += gauss(from, to, s => Math.exp(lnF(a * a + s * s)) * s * kernel(s, a)); from = to; }
    // Beyond, in y = s^-(2 c - 3), where the integrand is smooth.
    const power = 2 * exponent - 3;
    return sum + gauss(0, Math.pow(from, -power), y => {
      const s = Math.pow(y, -1 / power);
      return Math.exp(lnF(a * a + s * s) + 2 * exponent * Math.log(s)) * kernel(s, a) / s / power;
    });
  };
  // Z / pi.
  let mass = 0, from = 0;
  for (const to of knots.slice(1)) { mass += gauss(from, to, r => 2 * r * Math.exp(lnF(r * r))); from = to; }
  const tail = 2 * exponent - 2;
  mass += gauss(0, Math.pow(from, -tail), y => { const r = Math.pow(y, -1 / tail); return 2 * Math.exp(lnF(r * r) + 2 * exponent * Math.log(r)) / tail; });
  const ratio = w => {
    const a = Math.sinh(Math.abs(w)), M = 2 / (Math.PI * mass) * integral(a);
    return 2 * Math.exp(w) * (w < 0 ? a + M : M);
  };
  const nodes = Math.round(RATIO_END / NODE_STEP) + 1, at = [];
  for (let i = -2; i < nodes + 2; ++i) at.push(ratio(i * NODE_STEP));
  const texels = [], end = at[nodes + 1], slope = 4 - 2 * exponent, far = ratio(RATIO_END + 1.5);
  if (end > 1e-9) {
    const near = Math.exp(-2 * RATIO_END), bend = (Math.log(end / far) + 1.5 * slope) / (near - Math.exp(-2 * RATIO_END - 3));
    texels.push(Math.log(end) - bend * near, slope, bend, RATIO_END);
  } else texels.push(-80, 0, 0, RATIO_END);
  texels.push(NODE_STEP, 0, 0, 0);
  for (const [left, c] of pieces) texels.push(left, 0, 0, 0, c[0] - Math.log(mass), c[1], c[2], c[3]);
  for (let i = 2; i < nodes + 2; ++i) texels.push(at[i], (at[i - 2] - 8 * at[i - 1] + 8 * at[i + 1] - at[i + 2]) / (12 * NODE_STEP), 0, 0);
  return {nodes, pieces: pieces.length, gamma: lobe.spline ? 0 : exponent, texels};
}
const spherical = (theta, phi) => [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];

// ---- parameter sliders ----
const SLIDER = 1000;
function scaleOf(p) { return p.log ? {to: v => Math.log(v / p.low) / Math.log(p.high / p.low), from: t => p.low * Math.pow(p.high / p.low, t)}
                                   : {to: v => (v - p.low) / (p.high - p.low), from: t => p.low + t * (p.high - p.low)}; }
const sliders = [];
function number(v) { return v === 0 ? '0' : Math.abs(v) < 1e-3 || Math.abs(v) >= 1e4 ? v.toExponential(2) : v.toPrecision(4); }
function addSlider(label, aria, p, get, set) {
  const row = document.createElement('div'); row.className = 'param';
  const name = document.createElement('label'), input = document.createElement('input'), out = document.createElement('output');
  input.type = 'range'; input.min = 0; input.max = SLIDER; input.step = 'any'; input.id = 'p' + sliders.length; name.htmlFor = input.id;
  name.append(...label); input.setAttribute('aria-label', aria);
  row.append(name, input, out); $('sliders').append(row);
  const scale = scaleOf(p), start = get();
  const show = () => { out.textContent = number(get()) + (p.unit === 'deg' ? '°' : ''); input.setAttribute('aria-valuetext', out.textContent);
                       row.classList.toggle('moved', Math.abs(get() - start) > 1e-9 * Math.max(1, Math.abs(start))); };
  input.addEventListener('input', () => { set(scale.from(input.value / SLIDER)); show(); update(); });
  input.addEventListener('keydown', e => {  // fine steps
    const d = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[e.key];
    if (!d) return;
    e.preventDefault();
    input.value = Number(input.value) + d * (e.shiftKey ? 1 : 10); set(scale.from(input.value / SLIDER)); show(); update();
  });
  const place = () => { input.value = SLIDER * Math.min(1, Math.max(0, scale.to(get()))); show(); };
  sliders.push({input, place, reset: () => { set(start); place(); }, aria});
  place();
}
// "α_x" with what follows the underscore lowered, then `rest`: nodes, since names of channels come from files.
function labelOf(p, rest) {
  const [symbol, lowered] = p.symbol.split('_'), nodes = [symbol];
  if (lowered) {
    const sub = document.createElement('sub');
    sub.textContent = lowered;
    nodes.push(sub);
  }
  if (p.lobe > 0) nodes.push(` (${p.lobe + 1})`);
  return nodes.concat(rest);
}
data.parameters.forEach((p, i) => {
  if (!p.free) return;
  if (p.values.length <= 3) {
    const channel = c => p.values.length > 1 ? ' ' + data.channels[c] : '';
    p.values.forEach((_, c) => addSlider(labelOf(p, channel(c)), p.name + channel(c), p, () => values[i][c], v => { values[i][c] = v; }));
  } else {  // many channels move together
    let factor = 1;
    addSlider(labelOf(p, ' ×'), p.name + ' factor', {low: 0.1, high: 4, log: true, unit: ''}, () => factor,
      v => { factor = v; values[i] = p.values.map(x => x * factor); });
  }
});
$('reset').addEventListener('click', () => { sliders.forEach(s => s.reset()); update(); });

// ---- the slice ----
const slices = data.slices.list;
const thetaSelect = $('theta'), phiSelect = $('phi');
const degrees = v => (Math.round(v * 10) / 10) + '°';
const stays = data.slices.outgoing ? 'o' : 'i', sweeps = data.slices.outgoing ? 'i' : 'o';
const phis = [...new Set(slices.map(s => s.phi))];
phis.forEach((phi, k) => phiSelect.add(new Option(degrees(phi), k)));
function fillThetas(keep) {
  const of = slices.map((s, i) => i).filter(i => slices[i].phi === phis[phiSelect.value || 0]);
  thetaSelect.replaceChildren(...of.map(i => new Option(degrees(slices[i].theta), i)));
  let best = of[0];
  of.forEach(i => { if (Math.abs(slices[i].theta - keep) < Math.abs(slices[best].theta - keep)) best = i; });
  thetaSelect.value = best;
}
const W = 860, H = 430, box = {x: 64, y: 12, w: W - 76, h: H - 62};
let logarithmic = true, drawn = null;
const svgns = 'http:' + '//www.w3.org/2000/svg';
function el(name, attributes, text) {
  const e = document.createElementNS(svgns, name);
  for (const k in attributes) e.setAttribute(k, attributes[k]);
  if (text !== undefined) e.textContent = text;
  return e;
}
function pairOf(slice, degreesOfMoving) {
  const fixed = spherical(slice.theta * rad, slice.phi * rad);
  const moving = spherical(Math.abs(degreesOfMoving) * rad, slice.phi * rad + (degreesOfMoving > 0 ? Math.PI : 0));
  return data.slices.outgoing ? [moving, fixed] : [fixed, moving];
}
function plotSlice() {
  const svg = $('slice');
  svg.replaceChildren();
  if (!slices.length) return;
  const slice = slices[thetaSelect.value], shown = data.shown;
  let curves;
  if (gl) {
    const angles = [];
    for (let d = -89.5; d <= 89.5; d += 0.5) angles.push(d);
    const f = evaluate(angles.map(d => pairOf(slice, d)));
    curves = shown.map(c => angles.map((d, i) => [d, f[c][i]]));
  } else {
    curves = shown.map((_, k) => slice.x.map((x, i) => [x, slice.f[k][i]]));
  }
  const measured = slice.y.flat().filter(v => v > 0), all = measured.concat(curves.flat().map(p => p[1])).filter(v => v > 0);
  let high = Math.max(...all) * 1.2, low = 0;
  if (logarithmic) {
    const sorted = measured.slice().sort((a, b) => a - b);
    low = Math.max(high * 1e-6, Math.min(sorted.length ? sorted[Math.floor(sorted.length / 50)] : high / 100, high / 10) / 1.3);
  }
  const X = d => box.x + box.w * (d + 90) / 180;
  const Y = v => box.y + box.h * (1 - (logarithmic ? Math.log(Math.max(v, low * 0.1) / low) / Math.log(high / low) : v / high));
  const clip = el('clipPath', {id: 'clip'}); clip.append(el('rect', {x: box.x, y: box.y, width: box.w, height: box.h}));
  const defs = el('defs', {}); defs.append(clip); svg.append(defs);
  for (let d = -90; d <= 90; d += 30) {
    svg.append(el('line', {x1: X(d), x2: X(d), y1: box.y, y2: box.y + box.h, stroke: '#e9ecef'}));
    svg.append(el('text', {x: X(d), y: box.y + box.h + 18, 'text-anchor': 'middle'}, String(d).replace('-', '−')));
  }
  const ticks = [];
  if (logarithmic) for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); ++e) {
    const few = high / low < 100 && Math.abs(e) <= 3;  // decimals at 1, 2 and 5 where there is hardly a power of ten
    for (const digit of few ? [1, 2, 5] : [1]) {
      const v = digit * Math.pow(10, e);
      if (v >= low && v <= high) ticks.push([v, few ? String(Number(v.toPrecision(3))) : e === 0 ? '1' : e === 1 ? '10' : '10^' + e]);
    }
  }
  else { const raw = high / 5, p = Math.pow(10, Math.floor(Math.log10(raw))), step = [1, 2, 5, 10].map(s => s * p).find(s => s >= raw);
         for (let v = 0; v <= high; v += step) ticks.push([v, String(Number(v.toPrecision(6)))]); }
  ticks.forEach(([v, label]) => {
    svg.append(el('line', {x1: box.x, x2: box.x + box.w, y1: Y(v), y2: Y(v), stroke: '#e9ecef'}));
    const t = el('text', {x: box.x - 7, y: Y(v) + 4, 'text-anchor': 'end'});
    const parts = label.split('^');
    t.append(parts[0]);
    if (parts.length > 1) t.append(el('tspan', {dy: -5, 'font-size': 9}, parts[1].replace('-', '−')));
    svg.append(t);
  });
  const inner = el('g', {'clip-path': 'url(#clip)'});
  inner.append(el('line', {x1: X(slice.theta), x2: X(slice.theta), y1: box.y, y2: box.y + box.h, stroke: '#969ea7', 'stroke-dasharray': '5 4'}));
  const points = [];
  shown.forEach((c, k) => {
    slice.x.forEach((x, i) => {
      const v = slice.y[k][i];
      if (v <= 0 && logarithmic) return;
      inner.append(el('circle', {cx: X(x).toFixed(1), cy: Y(v).toFixed(1), r: slice.x.length > 120 ? 2 : 3, fill: data.colors[c], 'fill-opacity': 0.5}));
      points.push([X(x), Y(v), x, v, c, gl ? 0 : slice.f[k][i]]);
    });
  });
  shown.forEach((c, k) => inner.append(el('path', {class: 'curve', d: 'M' + curves[k].map(p => X(p[0]).toFixed(1) + ' ' + Y(p[1]).toFixed(2)).join('L'),
    fill: 'none', stroke: data.channels.length === 1 ? '#1b1f24' : data.dark[c], 'stroke-width': 1.8})));
  const marker = el('circle', {r: 6, fill: 'none', stroke: '#1b1f24', 'stroke-width': 1.5, cx: -20, cy: -20, id: 'marker'});
  inner.append(marker);
  svg.append(inner, el('rect', {x: box.x, y: box.y, width: box.w, height: box.h, fill: 'none', stroke: '#969ea7'}));
  svg.append(el('text', {x: box.x + box.w / 2, y: H - 8, 'text-anchor': 'middle', class: 'axis'}, 'θ' + (sweeps === 'o' ? 'ₒ' : 'ᵢ') + ' (degrees; mirror direction, dashed, positive)'));
  svg.append(el('text', {x: 16, y: box.y + box.h / 2, 'text-anchor': 'middle', class: 'axis', transform: `rotate(-90 16 ${box.y + box.h / 2})`}, 'f (1/sr)'));
  drawn = {points, marker, slice, at: -1};
  $('point').max = Math.max(0, points.length - 1);
  svg.setAttribute('aria-label', `Slice at theta_${stays} ${degrees(slice.theta)}, azimuth ${degrees(slice.phi)}: ${slice.x.length} measured angles and the fitted curve. The slider below steps through the measured values.`);
}
function showPoint(i) {
  const p = drawn.points[i];
  if (!p) return;
  drawn.at = i;
  drawn.marker.setAttribute('cx', p[0]); drawn.marker.setAttribute('cy', p[1]);
  const f = gl ? evaluate([pairOf(drawn.slice, p[2])])[p[4]][0] : p[5];
  $('point').value = i;
  $('hover').textContent = `${data.channels.length > 1 ? data.channels[p[4]] + ', ' : ''}θ${sweeps === 'o' ? 'ₒ' : 'ᵢ'} ${degrees(p[2])}: measured ${number(p[3])}, model ${number(f)} 1/sr (ratio ${(p[3] / f).toPrecision(3)})`;
  $('point').setAttribute('aria-valuetext', $('hover').textContent);
}
$('slice').addEventListener('pointermove', e => {
  if (!drawn) return;
  const r = $('slice').getBoundingClientRect(), x = (e.clientX - r.left) * W / r.width, y = (e.clientY - r.top) * H / r.height;
  let best = -1, least = 900;
  drawn.points.forEach((p, i) => { const d = (p[0] - x) ** 2 + (p[1] - y) ** 2; if (d < least) { least = d; best = i; } });
  if (best >= 0) showPoint(best);
});
$('slice').addEventListener('keydown', e => {
  const d = {ArrowRight: 1, ArrowLeft: -1}[e.key];
  if (d && drawn) { e.preventDefault(); showPoint(Math.min(drawn.points.length - 1, Math.max(0, drawn.at + d))); }
});
$('point').addEventListener('input', () => showPoint(Number($('point').value)));
thetaSelect.addEventListener('change', plotSlice);
phiSelect.addEventListener('change', () => { fillThetas(slices[thetaSelect.value].theta); plotSlice(); });
$('scale').addEventListener('click', () => { logarithmic = !logarithmic; $('scale').setAttribute('aria-pressed', String(logarithmic)); plotSlice(); });
if (slices.length) {
  if (phis.length < 2) $('phiBox').classList.add('hidden');
  fillThetas(45);
} else $('sliceSection').classList.add('hidden');

// ---- the spheres ----
let gl = null, program = null, light = [-0.45, 0.6, 0.75], uniforms = {};
function setLight(v) {
  const n = Math.hypot(...v);
  light = v.map(x => x / n);
  // The two sliders of the light: to the right and up, degrees from the viewer.
  $('lightX').value = Math.round(Math.atan2(light[0], light[2]) / rad);
  $('lightY').value = Math.round(Math.asin(light[1]) / rad);
  for (const id of ['lightX', 'lightY']) $(id).setAttribute('aria-valuetext', $(id).value + ' degrees');
}
function lightFromSliders() {
  const x = $('lightX').value * rad, y = $('lightY').value * rad;
  setLight([Math.sin(x) * Math.cos(y), Math.sin(y), Math.cos(x) * Math.cos(y)]);
  renderSpheres();
}
function half(base64) {  // 16-bit logarithms to floats
  const raw = atob(base64), out = new Uint16Array(raw.length / 2);
  for (let i = 0; i < out.length; ++i) out[i] = raw.charCodeAt(2 * i) | raw.charCodeAt(2 * i + 1) << 8;
  return out;
}
function startGl() {
  const canvas = $('sphere');
  gl = canvas.getContext('webgl2', {antialias: false, preserveDrawingBuffer: true});
  if (!gl) return false;
  const shader = (type, source) => { const s = gl.createShader(type); gl.shaderSource(s, source); gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s)); return s; };
  program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, '#version 300 es\nout vec2 at; uniform float edge; void main() { vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0; at = p * edge; gl_Position = vec4(p, 0.0, 1.0); }'));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, $('shader').textContent));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  for (const name of ['mode', 'lobes', 'channels', 'shape', 'kind', 'radial', 'coat', 'diffuseKind', 'parameters', 'profiles', 'pairs', 'light', 'exposure', 'texel', 'table', 'tableSize', 'edge']) {
    uniforms[name] = gl.getUniformLocation(program, name);
  }
  gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
  const t = data.table, size = t ? t.size : [1, 1, 1], texels = new Float32Array(4 * size[0] * size[1] * size[2]);
  if (t) {
    const q = half(t.data);
    for (let i = 0; i < q.length / 3; ++i) {
      const known = q[3 * i] > 0;
      for (let c = 0; c < 3; ++c) texels[4 * i + c] = t.low + (q[3 * i + c] - 1) / 65534 * (t.high - t.low);
      texels[4 * i + 3] = known ? 1 : 0;
    }
  }
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA16F, size[0], size[1], size[2], 0, gl.RGBA, gl.FLOAT, texels);
  for (const [k, v] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
                        [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_R, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_3D, k, v);
  gl.uniform1i(uniforms.table, 0);
  gl.uniform3fv(uniforms.tableSize, size);
  gl.uniform1i(uniforms.parameters, 1);
  gl.uniform1i(uniforms.pairs, 2);
  gl.uniform1i(uniforms.profiles, 3);
  for (const unit of [1, 2, 3]) {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    for (const k of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, k, gl.NEAREST);
    upload(unit, 1, 1, new Float32Array(4));
  }
  target = gl.createFramebuffer();
  targetPixels = gl.createRenderbuffer();
  return true;
}
function upload(unit, width, height, texels) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels);
}
// f_r of pairs [wi, wo] in every channel, by the shader that draws the sphere: [channel][pair].
let target = null, targetPixels = null;
function evaluate(pairs) {
  const n = pairs.length, channels = data.channels.length, texels = new Float32Array(8 * n);
  pairs.forEach(([wi, wo], i) => { texels.set(wi, 4 * i); texels.set(wo, 4 * (n + i)); });
  upload(2, n, 2, texels);
  setModel();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  gl.bindRenderbuffer(gl.RENDERBUFFER, targetPixels);
  gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA8, n, channels);
  gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, targetPixels);
  gl.viewport(0, 0, n, channels);
  gl.uniform1i(uniforms.mode, 2);
  gl.uniform1f(uniforms.edge, 1);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  const bytes = new Uint8Array(4 * n * channels), view = new DataView(bytes.buffer);
  gl.readPixels(0, 0, n, channels, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return data.channels.map((_, c) => pairs.map((_, i) => view.getFloat32(4 * (c * n + i), true)));
}
const MASKINGS = ['smith-separable', 'smith-unclamped', 'smith-height', 'smith-height-direction', 'v-cavity', 'implicit', 'schlick-smith', 'kelemen', 'none'];
const FRESNELS = ['schlick', 'conductor', 'dielectric', 'none', 'schlick-f82', 'curve', 'coat-layered', 'coat-refracted'];
// The tables of the profiles belong to their numbers: made again when one moved.
let profileKey = '', profiles = [];
function setProfiles() {
  const key = JSON.stringify(lobes.map(lobe => values.slice(lobe.first + 5, lobe.first + lobe.shapeParameters)));
  if (key === profileKey) return;
  profileKey = key;
  profiles = lobes.map((lobe, k) => lobe.shapeParameters > 5 && lobe.family !== 2 ? profileOf(k) : null);
  const width = Math.max(1, ...profiles.map(p => p ? p.texels.length / 4 : 1)), texels = new Float32Array(4 * width * Math.max(1, lobes.length));
  profiles.forEach((p, k) => { if (p) texels.set(p.texels, 4 * width * k); });
  upload(3, width, Math.max(1, lobes.length), texels);
}
function setModel() {
  setProfiles();
  const shape = [], kind = [], radial = [], channels = data.channels.length, rows = 2 * lobes.length + 2;
  const texels = new Float32Array(4 * channels * rows);
  lobes.forEach((lobe, k) => {
    const f = frameOf(k);
    shape.push(f.x, f.y, f.a, f.b);
    kind.push(f.c, lobe.family, MASKINGS.indexOf(lobe.masking), FRESNELS.indexOf(lobe.fresnel));
    const p = profiles[k];
    radial.push(p ? p.nodes : 0, p ? p.pieces : 0, p ? p.gamma : lobe.family === 2 ? values[lobe.first + 5][0] : 0, lobe.retro ? 1 : 0);
    for (let c = 0; c < channels; ++c) {
      for (let i = 0; i < lobe.fresnelParameters; ++i) {
        const v = values[lobe.first + lobe.shapeParameters + i];
        texels[4 * ((2 * k + (i >> 2)) * channels + c) + (i & 3)] = v[v.length === 1 ? 0 : c];
      }
    }
  });
  for (let c = 0; c < channels; ++c) {
    const diffuse = data.model.diffuse ? values[values.length - 1] : [0];
    texels.set([diffuse[diffuse.length === 1 ? 0 : c], ...data.rgb[c]], 4 * (2 * lobes.length * channels + c));
    if (data.model.diffuse > 2) {
      const own = values[values.length - 2];
      texels[4 * ((2 * lobes.length + 1) * channels + c)] = own[own.length === 1 ? 0 : c];
    }
  }
  upload(1, channels, rows, texels);
  gl.uniform1i(uniforms.lobes, lobes.length);
  gl.uniform1i(uniforms.channels, channels);
  gl.uniform1i(uniforms.coat, lobes.findIndex((lobe) => lobe.fresnel.startsWith('coat')));
  gl.uniform1i(uniforms.diffuseKind, data.model.diffuse);
  if (shape.length) { gl.uniform4fv(uniforms.shape, shape); gl.uniform4fv(uniforms.kind, kind); gl.uniform4fv(uniforms.radial, radial); }
  gl.uniform3fv(uniforms.light, light);
  gl.uniform1f(uniforms.exposure, data.exposure);
}
function renderSphere(x, y, size, measured, edge) {
  gl.viewport(x, y, size, size);
  gl.uniform1i(uniforms.mode, measured);
  gl.uniform1f(uniforms.edge, edge);
  gl.uniform1f(uniforms.texel, 2 * edge / size);
  gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
}
function renderSpheres() {
  if (!gl) return;
  const canvas = $('sphere'), count = data.table ? 2 : 1, size = Math.min(720, Math.max(64, Math.round(canvas.clientWidth / 2 * (window.devicePixelRatio || 1))));
  if (canvas.width !== 2 * size) { canvas.width = 2 * size; canvas.height = size; }
  setModel();
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(1, 1, 1, 1); gl.clear(gl.COLOR_BUFFER_BIT);
  if (count === 2) renderSphere(0, 0, size, 1, 1.04);
  renderSphere(count === 2 ? size : size / 2, 0, size, 0, 1.04);
}
function moveLight(e) {
  const r = $('sphere').getBoundingClientRect(), size = r.width / 2;
  let x = (e.clientX - r.left) - (data.table ? 0 : size / 2);
  x = (data.table ? x % size : x) / size * 2 - 1;
  const y = 1 - (e.clientY - r.top) / size * 2, d = Math.min(0.98, Math.hypot(x, y)), n = Math.hypot(x, y) || 1;
  const nx = x / n * d, ny = y / n * d, nz = Math.sqrt(1 - d * d);
  setLight([2 * nz * nx, 2 * nz * ny, 2 * nz * nz - 1]);  // the highlight comes to the pointer
  renderSpheres();
}
$('sphere').addEventListener('pointerdown', e => { $('sphere').setPointerCapture(e.pointerId); moveLight(e); });
$('sphere').addEventListener('pointermove', e => { if (e.buttons) moveLight(e); });
for (const id of ['lightX', 'lightY']) $(id).addEventListener('input', lightFromSliders);
setLight(light);
let failure = '';
try { if (!startGl()) failure = 'WebGL 2 is not available'; } catch (e) { gl = null; failure = String(e); }
if (!gl) { for (const id of ['sphereSection', 'parameterSection']) $(id).classList.add('hidden'); $('noGl').classList.remove('hidden'); }
if (!data.table) $('names').firstElementChild.remove();
function update() { plotSlice(); renderSpheres(); }
window.addEventListener('resize', renderSpheres);
update();
