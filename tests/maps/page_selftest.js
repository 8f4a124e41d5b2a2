// The page of maps tests itself, behind `const truth = {...}`: the program's picture under two lights, bytes of R, G, B from the top.
// It runs when the page is ready and sees the constants of maps.js.
const violations = [];
document.addEventListener('securitypolicyviolation', e => violations.push(e.violatedDirective + ' ' + e.sample));
addEventListener('load', () => {
  const result = {webgl: !!gl, failure, violations, title: document.title, hidden: $('relitSection').classList.contains('hidden'),
    requests: performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:')).length,
    unnamed: [...document.querySelectorAll('input,select,button,canvas,img')].filter(e => !(e.labels && e.labels.length) && !e.getAttribute('aria-label') && !e.getAttribute('alt') && !e.textContent.trim()).length};
  if (gl) {
    const {width, height} = data, bytes = new Uint8Array(4 * width * height);
    const read = () => { render(); gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes); return bytes.slice(); };
    let worst = 0, sum = 0, lit = 0;
    for (const {light: v, picture} of truth) {
      setLight(v);
      const got = read(), want = atob(picture);
      for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) for (let c = 0; c < 3; ++c) {
        const off = Math.abs(got[4 * ((height - 1 - y) * width + x) + c] - want.charCodeAt(3 * (y * width + x) + c));
        if (off > worst) result.where = [x, y, c, got[4 * ((height - 1 - y) * width + x) + c], want.charCodeAt(3 * (y * width + x) + c), ...v]; worst = Math.max(worst, off); sum += off; lit += want.charCodeAt(3 * (y * width + x) + c) > 8 ? 1 : 0;
      }
    }
    const count = truth.length * width * height * 3;
    result.relitWorst = worst; result.relitMean = sum / count; result.lit = lit / count;
    const before = read();
    $('lights').value = '2'; $('lights').dispatchEvent(new Event('change'));
    result.photographFollows = read().some((v, i) => Math.abs(v - before[i]) > 20);
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent('pointermove', {buttons: 1, clientX: box.left + 0.9 * box.width, clientY: box.top + box.height / 2}));
    result.draggedX = light[0]; result.chosen = $('lights').value;
    const bright = read();
    $('exposure').value = '-2'; $('exposure').dispatchEvent(new Event('input'));
    result.exposureDarkens = read().every((v, i) => i % 4 === 3 || v <= bright[i]);
  }
  const pre = document.createElement('pre');
  pre.id = 'result';
  pre.textContent = JSON.stringify(result);
  document.body.append(pre);
});
