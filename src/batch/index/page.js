"use strict";
// The data: {columns: [{name, text, error}], rows: [[...]], status: column of the status, ...}; see src/batch/index/index_page.h.
const data = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);
const make = (tag, className, text) => {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
};
const column = (name) => data.columns.findIndex((c) => c.name === name);
const idColumn = column("id"), statusColumn = column("status"), messageColumn = column("message"), verdictColumn = column("verdict"), modelColumn = column("recipe");
const shownRows = 200, step = 500;
let order = [], descending = false, tableRows = step;

const number = (value) => {
  if (typeof value !== "number") return value === null ? "" : String(value);
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-4 || size >= 1e6) ? value.toExponential(3) : String(Number(value.toPrecision(5)));
};
const linkTo = (row, ending) => "documents/" + row[idColumn].split("/").map(encodeURIComponent).join("/") + ending;

function showTotals() {
  const totals = get("totals"), shares = get("shares");
  const words = { listed: "listed", fitted: "fitted", doubtful: "doubtful", failed: "failed", crashed: "crashed", missing: "missing" };
  for (const [name, word] of Object.entries(words)) {
    const count = data.totals[name] || 0;
    if (count === 0 && name !== "listed" && name !== "fitted") continue;
    const tile = make("div", "total " + name);
    tile.append(make("b", "", count.toLocaleString("en")), word);
    totals.append(tile);
    if (name === "listed") continue;
    const share = make("i", name);
    share.style.width = (100 * count / Math.max(1, data.totals.listed)) + "%";
    share.title = word + ": " + count;
    shares.append(share);
  }
  shares.setAttribute("aria-label", Object.entries(data.totals).map(([name, count]) => name + " " + count).join(", "));
  for (const [verdict, count] of Object.entries(data.verdicts)) {
    const tile = make("div", "total");
    tile.append(make("b", "", count.toLocaleString("en")), "verdict " + verdict);
    totals.append(tile);
  }
}

function showFailures() {
  const failed = data.rows.filter((row) => row[statusColumn] === "failed" || row[statusColumn] === "crashed");
  get("failures").hidden = data.totals.failed + data.totals.crashed === 0;
  for (const row of failed.slice(0, shownRows)) {
    const box = make("div", "failure");
    const message = row[messageColumn] || "", named = row[idColumn] + ": ";
    box.append(make("b", "", row[idColumn]), message.startsWith(named) ? message.slice(named.length) : message);
    get("failureList").append(box);
  }
  const more = data.totals.failed + data.totals.crashed - Math.min(shownRows, failed.length);
  if (more > 0) get("failureList").append(make("p", "note", more + " more are in results.csv"));
  get("missing").hidden = data.totals.missing === 0;
  const rest = data.totals.missing - data.missing.length;
  get("missingText").textContent = data.missing.join(", ") + (rest > 0 ? " and " + rest + " more" : "");
}

function matches(row, words) {
  const text = row.join(" ").toLowerCase();
  return words.every((word) => text.includes(word));
}

function arrange() {
  const words = get("filter").value.toLowerCase().split(/\s+/).filter((word) => word);
  const by = Number(get("sort").value);
  order = data.rows.map((row, index) => index).filter((index) => matches(data.rows[index], words));
  const less = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true }));
  order.sort((i, j) => {
    const a = data.rows[i][by], b = data.rows[j][by];
    if ((a === null) !== (b === null)) return a === null ? 1 : -1;
    const sign = a === null ? 0 : less(a, b);
    return (descending ? -sign : sign) || i - j;
  });
  get("count").textContent = order.length + " of " + data.rows.length;
  tableRows = step;
  showGallery();
  showTable();
  showScatter();
}

function card(index) {
  const row = data.rows[index], picture = data.pictures[index];
  const box = make("div", "card " + row[statusColumn]);
  const spheres = make("div", "spheres");
  // Measured and fitted side by side in one picture, or only the fitted one.
  const names = picture && picture.measured ? ["measured", "fitted"] : ["fitted"];
  if (picture) {
    names.forEach((name, k) => {
      const figure = make("figure");
      const frame = make("div"), image = make("img");
      frame.style.cssText = "width:64px;height:64px;overflow:hidden";
      image.src = "data:image/png;base64," + picture.png;
      image.alt = "sphere, " + name;
      image.style.cssText = "width:" + 64 * names.length + "px;max-width:none;margin-left:" + -64 * k + "px";
      frame.append(image);
      figure.append(frame, name);
      spheres.append(figure);
    });
  }
  const name = make("a", "name", row[idColumn]);
  name.title = row[idColumn];
  name.href = data.reports.includes(index) ? linkTo(row, ".report.html") : linkTo(row, ".material.json");
  const said = row[verdictColumn] || row[statusColumn];
  box.append(spheres, name, make("span", "words", said + (row[modelColumn] ? " · " + row[modelColumn] : "")));
  return box;
}

function showGallery() {
  const withPicture = order.filter((index) => data.pictures[index]);
  get("gallery").replaceChildren(...withPicture.map(card));
  const rest = order.length - withPicture.length;
  get("galleryNote").textContent = rest > 0 ? "Without a picture: " + rest + " of " + order.length + ", which were not fitted, hold a table of lobes, or come after the first " + data.most_pictures + "." : "";
}

function showTable() {
  const head = make("tr");
  data.columns.forEach((c, i) => {
    const by = Number(get("sort").value);
    const cell = make("th", c.text ? "text" : ""), button = make("button", "", c.name + (i === by ? (descending ? " ▼" : " ▲") : ""));
    button.type = "button";
    if (i === by) cell.setAttribute("aria-sort", descending ? "descending" : "ascending");
    cell.append(button);
    button.addEventListener("click", () => {
      descending = i === by ? !descending : false;
      get("sort").value = i;
      get("order").setAttribute("aria-pressed", descending);
      arrange();
      get("table").tHead.rows[0].cells[i].firstChild.focus({ preventScroll: true });
    });
    head.append(cell);
  });
  get("table").tHead.replaceChildren(head);
  const body = order.slice(0, tableRows).map((index) => {
    const row = data.rows[index], line = make("tr", row[statusColumn]);
    line.id = "row" + index;
    data.columns.forEach((c, i) => {
      const cell = make("td", c.text ? "text" : "");
      if (i === idColumn && row[statusColumn] !== "failed" && row[statusColumn] !== "crashed") {
        const link = make("a", "", row[i]);
        link.href = linkTo(row, ".material.json");
        cell.append(link);
        if (data.reports.includes(index)) {
          const report = make("a", "report", "report");
          report.href = linkTo(row, ".report.html");
          cell.append(" ", report);
        }
      } else {
        cell.textContent = number(row[i]);
      }
      if (c.text) cell.title = cell.textContent;
      line.append(cell);
    });
    return line;
  });
  get("table").tBodies[0].replaceChildren(...body);
  get("more").hidden = order.length <= tableRows;
}

// About five round numbers between two; decades and their parts where the scale is logarithmic.
function ticks(low, high, logarithmic) {
  const values = [];
  if (logarithmic) {
    const few = Math.log10(high / low) > 2;
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) {
      for (const m of few ? [1] : [1, 2, 5]) values.push(m * Math.pow(10, e));
    }
  } else {
    const raw = (high - low) / 5, power = Math.pow(10, Math.floor(Math.log10(raw)));
    const each = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw);
    for (let k = Math.ceil(low / each); k * each <= high; ++k) values.push(k * each);
  }
  return values.filter((v) => v >= low && v <= high);
}

function showScatter() {
  const svg = get("scatter"), box = { x: 80, y: 16, width: 800, height: 410 };
  const draw = (tag, attributes, text) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    if (text !== undefined) element.textContent = text;
    svg.append(element);
    return element;
  };
  svg.replaceChildren();
  const axes = ["x", "y"].map((name) => ({ at: Number(get(name).value), log: get(name === "x" ? "logX" : "logY").checked }));
  const fine = (value, axis) => typeof value === "number" && (!axis.log || value > 0);
  const points = order.filter((index) => axes.every((axis) => fine(data.rows[index][axis.at], axis)));
  get("scatterNote").textContent = points.length + " of " + order.length + " rows have both values; bars are 95 % intervals (of errors clustered by incidence where there are some).";
  if (points.length === 0) return;
  for (const axis of axes) {
    const values = points.map((index) => data.rows[index][axis.at]);
    let low = Math.min(...values), high = Math.max(...values);
    const margin = axis.log ? Math.pow(high / low, 0.05) || 1 : (high - low) * 0.05 || Math.abs(high) * 0.1 || 1;
    axis.low = axis.log ? low / Math.max(margin, 1.05) : low - margin;
    axis.high = axis.log ? high * Math.max(margin, 1.05) : high + margin;
    const part = (v) => (axis.log ? Math.log(v / axis.low) / Math.log(axis.high / axis.low) : (v - axis.low) / (axis.high - axis.low));
    axis.part = (v) => Math.min(1, Math.max(0, axis.log && v <= 0 ? 0 : part(v)));
  }
  const px = (v) => box.x + axes[0].part(v) * box.width, py = (v) => box.y + (1 - axes[1].part(v)) * box.height;
  for (const v of ticks(axes[0].low, axes[0].high, axes[0].log)) {
    draw("line", { class: "grid", x1: px(v), x2: px(v), y1: box.y, y2: box.y + box.height });
    draw("text", { x: px(v), y: box.y + box.height + 18, "text-anchor": "middle" }, number(v));
  }
  for (const v of ticks(axes[1].low, axes[1].high, axes[1].log)) {
    draw("line", { class: "grid", x1: box.x, x2: box.x + box.width, y1: py(v), y2: py(v) });
    draw("text", { x: box.x - 8, y: py(v) + 4, "text-anchor": "end" }, number(v));
  }
  draw("rect", { class: "axis", x: box.x, y: box.y, width: box.width, height: box.height });
  draw("text", { x: box.x + box.width / 2, y: 468, "text-anchor": "middle" }, data.columns[axes[0].at].name);
  draw("text", { x: 16, y: box.y + box.height / 2, "text-anchor": "middle", transform: "rotate(-90 16 " + (box.y + box.height / 2) + ")" }, data.columns[axes[1].at].name);
  for (const index of points) {
    const row = data.rows[index], x = row[axes[0].at], y = row[axes[1].at], status = row[statusColumn];
    const half = axes.map((axis) => (data.errors[axis.at] ? data.errors[axis.at][index] || 0 : 0));
    if (half[0] > 0) draw("line", { class: "bar " + status, x1: px(x - half[0]), x2: px(x + half[0]), y1: py(y), y2: py(y) });
    if (half[1] > 0) draw("line", { class: "bar " + status, x1: px(x), x2: px(x), y1: py(y - half[1]), y2: py(y + half[1]) });
    const dot = draw("circle", { class: "dot " + status, cx: px(x), cy: py(y), r: 3.5 });
    const title = document.createElementNS("http://www.w3.org/2000/svg", "title");
    title.textContent = row[idColumn] + ": " + number(x) + ", " + number(y);
    dot.append(title);
    dot.addEventListener("click", () => choose(index));
  }
}

function choose(index) {
  const at = order.indexOf(index);
  if (at >= tableRows) {
    tableRows = at + 1;
    showTable();
  }
  for (const line of document.querySelectorAll("tr.chosen")) line.classList.remove("chosen");
  const line = get("row" + index);
  line.classList.add("chosen");
  line.scrollIntoView({ block: "center" });
}

function fill(select, wanted, numeric) {
  data.columns.forEach((c, i) => {
    if (numeric && c.text) return;
    const option = make("option", "", c.name);
    option.value = i;
    option.selected = c.name === wanted;
    select.append(option);
  });
}

showTotals();
showFailures();
fill(get("sort"), "id", false);
const numeric = data.columns.filter((c) => !c.text).map((c) => c.name);
const firstX = numeric.includes("alpha_x") ? "alpha_x" : numeric[0];
fill(get("x"), firstX, true);
fill(get("y"), data.scatter_y || numeric.find((name) => name !== firstX), true);
get("scatterSection").hidden = numeric.length === 0;
for (const id of ["sort", "x", "y", "logX", "logY"]) get(id).addEventListener("change", arrange);
get("filter").addEventListener("input", arrange);
get("order").addEventListener("click", () => {
  descending = !descending;
  get("order").setAttribute("aria-pressed", descending);
  arrange();
});
get("more").addEventListener("click", () => {
  tableRows += step;
  showTable();
});
arrange();
