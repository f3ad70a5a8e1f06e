// SPDX-License-Identifier: MIT
"use strict";
const report = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);
const kLeastError = 1e-8;  // what is exact stands here on a logarithmic axis
const colors = ["#4477aa", "#228833", "#aa3377", "#ccbb44", "#66ccee", "#ee6677", "#777777", "#995500", "#000000"];
const charts = {};

const cellName = c => `${c.preset} ${c.width}×${c.height}`;
const pointName = p => p.label + (p.settings ? " " + p.settings : "");
const number = (v, digits = 3) => {
  if (v === null || v === undefined) return "–";
  if (v !== 0 && Math.abs(v) < 1e-3) return v.toExponential(digits - 2);
  return String(Number(Number(v).toPrecision(digits)));
};

function draw(id, config) {
  if (charts[id]) charts[id].destroy();
  config.options = Object.assign({ animation: false, maintainAspectRatio: false, responsive: true }, config.options);
  charts[id] = new Chart(byId(id), config);
}

function option(select, value, text) {
  const o = document.createElement("option");
  o.value = value;
  o.textContent = text;
  select.append(o);
}

function table(id, head, rows) {
  const t = byId(id);
  t.replaceChildren();
  const line = (cells, tag, row) => {
    const tr = t.insertRow();
    if (row && row.className) tr.className = row.className;
    for (const cell of cells) {
      const td = document.createElement(tag);
      if (cell && cell.text !== undefined) { td.textContent = cell.text; td.className = cell.className; }
      else { td.textContent = cell; if (/^[–\d]/.test(cell)) td.className = "n"; }
      tr.append(td);
    }
  };
  line(head, "th");
  for (const row of rows) line(row.cells, "td", row);
}

function drawScatter(cell) {
  const at = p => ({ x: p.execute.median, y: Math.max(p.error.p9999 ?? 1, kLeastError), p });
  const known = cell.points.filter(p => p.error && p.execute.median > 0);
  const front = known.filter(p => p.front).sort((a, b) => a.execute.median - b.execute.median);
  const ys = known.map(p => at(p).y);
  const low = Math.min(...ys, 1e-7) / 2, high = Math.max(...ys, 1e-2) * 2;
  const floor = (label, x, color) => ({ label, data: [{ x, y: low }, { x, y: high }], showLine: true, pointRadius: 0, borderColor: color, borderDash: [6, 4], borderWidth: 1.5 });
  draw("scatter", {
    type: "scatter",
    data: { datasets: [
      { label: "choices", data: known.filter(p => !p.front).map(at), backgroundColor: colors[0], pointRadius: 6 },
      { label: "front: nothing is both faster and closer", data: front.map(at), backgroundColor: "#cc3311", borderColor: "#cc3311", showLine: true, pointRadius: 7 },
      floor("one RGBA32F copy pass", cell.copy.median, "#888"),
      floor(`memory: ${number(cell.gigabytes_per_second)} GB/s`, cell.memory.median, "#bb9900"),
    ] },
    options: {
      scales: {
        x: { type: "logarithmic", title: { display: true, text: "milliseconds (median)" } },
        y: { type: "logarithmic", min: low, max: high, title: { display: true, text: "error, 99.99th percentile" },
             ticks: { callback: v => Number.isInteger(Math.log10(v)) ? v.toExponential(0) : "" } },
      },
      plugins: { tooltip: {
        filter: item => item.raw.p !== undefined,
        callbacks: { label: item => {
          const p = item.raw.p;
          return [pointName(p), p.choice, `${number(p.execute.median, 4)} ms (${number(p.execute.lower_quartile, 4)} to ${number(p.execute.upper_quartile, 4)})`,
                  `error ${number(p.error.p9999)}, at most ${number(p.error.max)}`, `${p.kernels} kernels`];
        } } } },
    },
  });
  byId("truth").textContent = `Error against: ${cell.truth}.`;
  const base = cell.points[0];
  table("points", ["choice", "executes", "ms", "quartiles", base ? `÷ ${base.label}` : "", "÷ copy", "upload", "read-back", "kernels", "p99.99", "max", "rms", "PSNR", "visible"],
    cell.points.map(p => ({ className: p.front ? "front" : "", cells: [
      pointName(p), p.choice, number(p.execute.median, 4), `${number(p.execute.lower_quartile, 4)} – ${number(p.execute.upper_quartile, 4)}`,
      number(base.execute.median / p.execute.median), number(p.execute.median / cell.copy.median), number(p.upload), number(p.read_back), String(p.kernels),
      number(p.error?.p9999), number(p.error?.max), number(p.error?.rms), p.error ? number(p.error.psnr) : "–",
      p.error && p.error.visible !== null ? `${number(100 * p.error.visible)} %` : "–"] })));
}

function drawPasses(point) {
  const passes = point ? point.passes : [];
  byId("passes-box").style.height = `${Math.max(8, 3 + 1.35 * passes.length)}rem`;
  draw("passes", {
    type: "bar",
    data: { labels: passes.map(p => p.name), datasets: [{ label: "milliseconds", data: passes.map(p => p.milliseconds), backgroundColor: colors[0] }] },
    options: { indexAxis: "y", plugins: { legend: { display: false } }, scales: { x: { title: { display: true, text: "milliseconds" } }, y: { ticks: { autoSkip: false } } } },
  });
}

function drawScaling() {
  const lines = new Map();
  const add = (name, cell, spread) => {
    const pixels = cell.width * cell.height;
    if (!(spread.median > 0)) return;
    if (!lines.has(name)) lines.set(name, []);
    const y = spread.median * 1e6 / pixels, same = lines.get(name).find(d => d.x === pixels);
    if (same) same.y = Math.min(same.y, y);  // a floor that several cells have measured
    else lines.get(name).push({ x: pixels, y, size: `${cell.width}×${cell.height}` });
  };
  for (const cell of report.cells) {
    cell.points.forEach((p, i) => {  // the baseline and what run does; all others are in the charts above
      if ((i === 0 || p.label === "chosen") && !p.settings) add(`${cell.preset}: ${pointName(p)}`, cell, p.execute);
    });
    add("one copy pass", cell, cell.copy);
    add("memory", cell, cell.memory);
  }
  const kept = [...lines].filter(([, data]) => new Set(data.map(d => d.x)).size > 1);
  draw("scaling", {
    type: "scatter",
    data: { datasets: kept.map(([label, data], i) => ({ label, data: data.sort((a, b) => a.x - b.x), showLine: true, borderColor: colors[i % colors.length], backgroundColor: colors[i % colors.length], pointRadius: 4 })) },
    options: {
      scales: { x: { type: "logarithmic", title: { display: true, text: "pixels" } }, y: { type: "logarithmic", title: { display: true, text: "ns a pixel" } } },
      plugins: { tooltip: { callbacks: { label: item => `${item.dataset.label}, ${item.raw.size}: ${number(item.raw.y)} ns a pixel` } } },
    },
  });
}

function drawGoals() {
  const rows = report.goals.map(g => ({ cells: [
    g.name, g.size, g.measured === null ? { text: g.note || "not measured", className: "" } : number(g.measured) + (g.unit ? " " + g.unit : ""),
    `${g.at_least ? "≥" : "≤"} ${number(g.goal)}${g.next === null ? "" : `, then ${number(g.next)}`}`,
    g.measured === null ? "–" : { text: g.reached ? "yes" : "no", className: g.reached ? "yes" : "no" }] }));
  if (rows.length) table("goals", ["what", "size", "measured", "goal", "reached"], rows);
  else byId("goals").outerHTML = "<p>Not measured; see bench --goals.</p>";
}

const lookName = c => c.preset + (c.settings ? " " + c.settings : "");
const percent = v => `${number(100 * v)} %`;

function lines(id, sets, x, y, logarithmic) {
  const data = [...sets].map(([label, points], i) => ({ label, data: points, showLine: true, borderColor: colors[i % colors.length], backgroundColor: colors[i % colors.length], pointRadius: 3 }));
  draw(id, { type: "scatter", data: { datasets: data }, options: { scales: {
    x: { type: logarithmic ? "logarithmic" : "linear", title: { display: true, text: x } }, y: { title: { display: true, text: y } } } } });
}

function grouped(curves, points) {
  const sets = new Map();
  for (const c of curves) sets.set(lookName(c), (sets.get(lookName(c)) || []).concat(points(c)));
  return sets;
}

function chooseScene() {
  const scene = byId("scene").value;
  lines("light", grouped(report.temporal.filter(c => c.scene === scene), c => c.light.map((y, i) => ({ x: i + 3, y }))), "frame", "light, mean 1", false);
}

function drawSteady() {
  if (!report.temporal.length && !report.resolutions.length) { byId("steady").remove(); return; }
  lines("swing", grouped(report.temporal.filter(c => c.radius > 0), c => [{ x: c.radius, y: 100 * c.swing }]), "radius of the highlight, pixels", "swing, %", true);
  for (const scene of new Set(report.temporal.map(c => c.scene))) option(byId("scene"), scene, scene);
  byId("scene").onchange = chooseScene;
  chooseScene();
  table("shots", ["look", "shot", "size", "swing", "flicker", "of pixels"],
    report.temporal.map(c => ({ cells: [lookName(c), c.scene, `${c.width}×${c.height}`, percent(c.swing), percent(c.flicker), percent(c.pixels)] })));
  table("resolutions", ["look", "size", "largest difference", "RMS"],
    report.resolutions.map(p => ({ cells: [lookName(p), `${p.width}×${p.height}`, percent(p.worst), percent(p.rms)] })));
}

function choosePoint() { drawPasses(report.cells[byId("cell").value]?.points[byId("point").value]); }

function chooseCell() {
  const cell = report.cells[byId("cell").value];
  if (!cell) return;
  drawScatter(cell);
  byId("point").replaceChildren();
  cell.points.forEach((p, i) => option(byId("point"), i, pointName(p)));
  byId("point").value = cell.points.length - 1;
  choosePoint();
}

byId("about").textContent = `${report.device} · ${report.driver} · Afterglow ${report.afterglow} · medians of ${report.repeat}, all choices of a cell in turns`;
report.cells.forEach((c, i) => option(byId("cell"), i, cellName(c)));
byId("cell").onchange = chooseCell;
byId("point").onchange = choosePoint;
chooseCell();
drawScaling();
drawSteady();
drawGoals();
