// The page tests itself. The test puts this text before the page's policy, behind `const truth = {...}`: the program's picture of
// the sphere and values of f_r. It runs when the page is ready and sees the constants of page.js.
const violations = [];
let dialogs = 0;
document.addEventListener('securitypolicyviolation', e => violations.push(e.violatedDirective + ' ' + e.sample));
for (const name of ['alert', 'confirm', 'prompt', 'print']) window[name] = () => { ++dialogs; };
addEventListener('load', () => {
  const result = {webgl: !!gl, failure, violations, dialogs, title: document.title,
    // Elements and handlers that the page does not make: made of a name.
    elements: [...document.querySelectorAll('*')].filter(e => e.getAttributeNames().some(a => a.startsWith('on'))).length + document.querySelectorAll('body script:not([id])').length - 1 + document.querySelectorAll('img:not([src^="data:"])').length,
    requests: performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:')).length};
  if (gl) {
    const ref = truth.reference, n = ref.size, bytes = new Uint8Array(4 * n * n);
    const read = () => { setModel(); gl.disable(gl.BLEND); renderSphere(0, 0, n, 0, 1); gl.readPixels(0, 0, n, n, gl.RGBA, gl.UNSIGNED_BYTE, bytes); return bytes.slice(); };
    const first = read(), expected = atob(ref.data);
    let worst = 0, sum = 0, count = 0, background = 0;
    for (let row = 0; row < n; ++row) for (let col = 0; col < n; ++col) {
      const x = (col + 0.5) / n * 2 - 1, y = 1 - (row + 0.5) / n * 2;
      if (Math.hypot(x, y) > 1 - 2 / n) continue;
      for (let c = 0; c < 3; ++c) {
        const got = first[4 * ((n - 1 - row) * n + col) + c], want = expected.charCodeAt(3 * (row * n + col) + c);
        worst = Math.max(worst, Math.abs(got - want)); sum += Math.abs(got - want); ++count;
        if (got !== 255) ++background;
      }
    }
    result.sphereWorst = worst / 255; result.sphereMean = sum / count / 255; result.differsFromBackground = background / count;
    const s = sliders[0], before = s.input.value;
    s.input.value = before > SLIDER / 2 ? SLIDER * 0.2 : SLIDER * 0.8; s.input.dispatchEvent(new Event('input'));
    const moved = read();
    let changed = 0;
    for (let i = 0; i < moved.length; ++i) if (Math.abs(moved[i] - first[i]) > 2) ++changed;
    result.sliderChanges = changed / moved.length;
    if (slices.length) {
      const curve = () => document.querySelector('#slice .curve').getAttribute('d'), after = curve();
      $('reset').click();
      result.sliderMovesSlice = curve() !== after;
    }
    $('reset').click();
    const back = read();
    result.resetRestores = back.every((v, i) => v === first[i]);
    const was = light;
    $('lightX').value = 50; $('lightX').dispatchEvent(new Event('input'));
    result.lightChanges = read().some((v, i) => Math.abs(v - back[i]) > 20);
    setLight(was); renderSpheres();
  }
  if (slices.length > 1) {
    const curve = () => document.querySelector('#slice .curve').getAttribute('d');
    const before = curve();
    thetaSelect.selectedIndex = (thetaSelect.selectedIndex + 1) % thetaSelect.length; thetaSelect.dispatchEvent(new Event('change'));
    result.sliceFollows = curve() !== before;
    const log = curve();
    $('scale').click();
    result.scaleFollows = curve() !== log;
    $('scale').click();
  }
  if (drawn) { showPoint(0); result.hover = $('hover').textContent; }
  // The shader against values of the program.
  if (gl) {
    const got = evaluate(truth.check.map(([wi, wo]) => [wi, wo]));
    result.modelWorst = Math.max(...truth.check.map(([, , f], i) => Math.max(...f.map((v, c) => Math.abs(got[c][i] - v) / Math.max(v, 1e-12)))));
  }
  result.unnamed = [...document.querySelectorAll('input,select,button,canvas,svg[role],img')].filter(e => !(e.labels && e.labels.length) && !e.getAttribute('aria-label') && !e.getAttribute('alt') && !(e.tagName === 'BUTTON' && e.textContent)).length;
  const out = document.createElement('pre'); out.id = 'result'; out.textContent = JSON.stringify(result); document.body.append(out);
});
