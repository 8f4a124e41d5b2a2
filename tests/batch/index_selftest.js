// The overview tests itself when it is ready: what its controls do, told as JSON. It sees the constants of page.js.
const violations = [];
document.addEventListener('securitypolicyviolation', e => violations.push(e.violatedDirective + ' ' + e.sample));
const errors = [];
addEventListener('error', e => errors.push(e.message));
addEventListener('load', () => {
  const result = {};
  const at = name => data.columns.findIndex(c => c.name === name);
  const set = (id, value, event) => { get(id).value = value; get(id).dispatchEvent(new Event(event)); };
  const idsOfTable = () => [...get('table').tBodies[0].rows].map(row => row.cells[at('id')].firstChild.textContent);
  const headOf = name => get('table').tHead.rows[0].cells[at(name)];
  const numbers = (query, names) => [...document.querySelectorAll('#scatter ' + query)].map(e => names.map(n => Number(e.getAttribute(n))));
  const lines = query => numbers(query, ['x1', 'x2', 'y1', 'y2']);
  try {
    result.atFirst = idsOfTable();
    headOf('alpha_x').firstChild.click();
    result.byAlpha = idsOfTable(); result.sortIs = data.columns[Number(get('sort').value)].name; result.ascends = headOf('alpha_x').ariaSort;
    headOf('alpha_x').firstChild.click();
    result.byAlphaDown = idsOfTable(); result.descends = headOf('alpha_x').ariaSort; result.focusStays = document.activeElement === headOf('alpha_x').firstChild;
    get('order').click();
    set('sort', at('id'), 'change');
    result.galleryAtFirst = [...document.querySelectorAll('#gallery .name')].map(e => e.textContent);
    result.links = [...document.querySelectorAll('#gallery .name, #table td a')].map(e => e.getAttribute('href'));

    set('x', at('alpha_x'), 'change'); set('y', at('f0'), 'change');
    result.dots = numbers('.dot', ['cx', 'cy']); result.bars = lines('.bar');
    get('logX').click();
    result.logDots = numbers('.dot', ['cx', 'cy']);
    get('logX').click();
    document.querySelectorAll('#scatter .dot')[1].dispatchEvent(new MouseEvent('click'));
    result.chosen = [...document.querySelectorAll('tr.chosen')].map(row => row.cells[at('id')].firstChild.textContent);
    result.title = document.querySelectorAll('#scatter title')[1].textContent;

    set('filter', '  WIDE ggx', 'input');
    result.filtered = idsOfTable(); result.count = get('count').textContent; result.dotsFiltered = numbers('.dot', ['cx']).length;
    result.galleryFiltered = document.querySelectorAll('#gallery .card').length;
    set('filter', 'no such word', 'input');
    result.none = idsOfTable().length + document.querySelectorAll('#gallery .card, #scatter .dot').length;
    set('filter', '', 'input');
    result.again = idsOfTable().length;
    result.unnamed = [...document.querySelectorAll('input,select,button,img,svg')].filter(e => !(e.labels && e.labels.length) && !e.getAttribute('aria-label') && !e.getAttribute('alt') && !e.textContent.trim()).length;
  } catch (error) {
    errors.push(String(error));
  }
  Object.assign(result, {errors, violations, page: document.title, requests: performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:')).length});
  const pre = document.createElement('pre');
  pre.id = 'result';
  // As no markup, which the printed page would escape.
  pre.textContent = JSON.stringify(result).replace(/[<>&]/g, c => '\\u00' + c.charCodeAt(0).toString(16));
  document.body.append(pre);
});
