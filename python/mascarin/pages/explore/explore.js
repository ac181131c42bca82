"use strict";
// Sliders that ask the local server for a run, and curves that follow.
(() => {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const $ = (id) => document.getElementById(id);
  const values = {};
  const band = [...data.band];
  let now = data.reference, reference = data.reference;

  async function ask(path, content) {
    const answer = await fetch(path, {
      method: "POST", headers: { "Content-Type": "application/json", "X-Mascarin-Token": data.token }, body: JSON.stringify(content),
    });
    const found = await answer.json();
    if (!answer.ok || found.refused) throw new Error(found.refused || found.error);
    return found;
  }

  // --- curves: one chart for each unit -----------------------------------------------------------------------
  let plots = [];
  const groups = new Map();
  const labels = Object.fromEntries(data.curves.map((curve) => [curve.name, curve.label]));
  const quantities = Object.fromEntries(data.curves.map((curve) => [curve.unit, curve.quantity]));
  for (const curve of data.curves) groups.set(curve.unit, [...(groups.get(curve.unit) || []), curve.name]);
  function columns(unit, names) {
    const found = [data.times];
    for (const name of names) found.push(now.series[name], reference.series[name]);
    if (unit === "°C") found.push(data.outdoors);
    return found;
  }
  function build() {
    for (const { plot } of plots) plot.destroy();
    const target = $("plots");
    const narrow = innerWidth < 640;
    plots = [...groups].map(([unit, names], place) => {
      const lines = [Curves.time];
      names.forEach((name, k) => {
        const color = Curves.style(`--c${k % 8}`);
        lines.push(Curves.line(labels[name], color, unit, { width: 1.8 }), Curves.line("as described", color, unit, { dash: [4, 4], width: 1, class: "described" }));
      });
      if (unit === "°C") lines.push(Curves.line("outdoors", Curves.style("--soft"), unit, { width: 1, dash: [1, 3] }));
      const plot = new uPlot({
        width: target.clientWidth, height: place ? 170 : narrow ? 210 : 320, tzDate: Curves.local, axes: Curves.axes([quantities[unit], unit].filter(Boolean).join(", ")),
        scales: { x: { time: true } }, cursor: { sync: { key: "explore" }, drag: { x: true, y: false } },
        legend: { live: !narrow, show: !narrow || place === 0 }, hooks: Curves.quiet, series: lines,
      }, columns(unit, names), target);
      return { plot, unit, names };
    });
  }

  // --- tables ------------------------------------------------------------------------------------------------
  const cell = (tag, text, className) => {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    if (className) made.className = className;
    return made;
  };
  const number = (v) => Curves.shown(v, Math.abs(v) >= 99.95 ? 0 : 1);
  // Zones whose hours are in the sum; the person decides which of them count.
  const uncounted = new Set(data.uncounted);
  const MEASURES = ["hot", "hot_degree_hours", "cold", "cold_degree_hours"];
  function comfortRow(head, row, was) {
    const made = cell("tr");
    head.scope = "row";
    made.append(head);
    for (const key of MEASURES) made.append(cell("td", number(row[key]), "n"), cell("td", number(was[key]), "n"));
    return made;
  }
  function zoneHead(zone) {
    const head = cell("th"), label = cell("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = !uncounted.has(zone);
    box.dataset.zone = zone;
    box.addEventListener("change", () => {
      if (box.checked) uncounted.delete(zone); else uncounted.add(zone);
      fill();
      document.querySelector(`#comfort input[data-zone="${CSS.escape(zone)}"]`).focus();
    });
    label.append(box, ` ${zone.replaceAll("_", " ")}`);
    head.append(label);
    return head;
  }
  function summed(rows) {
    const counted = rows.filter(({ zone }) => !uncounted.has(zone));
    return Object.fromEntries(MEASURES.map((key) => [key, counted.reduce((sum, row) => sum + row[key], 0)]));
  }
  function fill() {
    const rows = now.comfort.map((row, k) => comfortRow(zoneHead(row.zone), row, reference.comfort[k]));
    const sum = comfortRow(cell("th", "sum of the ticked zones"), summed(now.comfort), summed(reference.comfort));
    sum.className = "sum";
    $("comfort").tBodies[0].replaceChildren(...rows, ...(rows.length > 1 ? [sum] : []));
    const most = Math.max(...[...now.energy, ...reference.energy].map(([, heat]) => Math.abs(heat)), 1e-9);
    const shown = now.energy.map((row, k) => [row, reference.energy[k]]).filter(([a, b]) => a[1] || b[1]);
    $("energy").tBodies[0].replaceChildren(...shown.map(([[flow, heat], [, was]]) => {
      const made = cell("tr"), head = cell("th", flow), bar = cell("span", undefined, "heat-bar"), part = cell("span", undefined, heat < 0 ? "out" : "in");
      head.scope = "row";
      const size = 50 * Math.abs(heat) / most;
      part.style.left = `${heat < 0 ? 50 - size : 50}%`;
      part.style.width = `${size}%`;
      bar.append(part);
      const last = cell("td");
      last.append(bar);
      made.append(head, cell("td", number(heat), "n strong"), cell("td", number(was), "n"), last);
      return made;
    }));
    $("warnings").replaceChildren(...now.warnings.map((line) => cell("li", line)));
  }

  function draw() {
    for (const { plot, unit, names } of plots) plot.setData(columns(unit, names), false);
    for (const { plot } of plots) {
      const { min, max } = plot.scales.x;
      plot.setScale("x", { min, max }); // keeps what was zoomed to, and fits the other axis
    }
    fill();
  }

  // --- one run at a time, the newest values next -------------------------------------------------------------
  let running = false, waiting = null;
  function want(renew = false) {
    waiting = { since: performance.now(), renew: renew || Boolean(waiting?.renew) };
    if (!running) next();
  }
  async function next() {
    const { since, renew } = waiting;
    waiting = null;
    running = true;
    const asked = { values: { ...values }, band: [...band] };
    try {
      if (renew) reference = await ask("/run", { values: {}, band: asked.band });
      now = await ask("/run", asked);
      complain("");
      draw();
      // After the browser has painted.
      requestAnimationFrame(() => setTimeout(() => {
        document.body.dataset.latency = (performance.now() - since).toFixed(1);
        document.body.dataset.runs = String(1 + Number(document.body.dataset.runs || 0));
      }));
    } catch (error) {
      complain(error instanceof TypeError ? "The server does not answer: 'mascarin explore' has ended. Start it again." : error.message);
    }
    running = false;
    if (waiting) next();
  }
  function complain(text) {
    for (const { message } of sliders) message.hidden = true;
    const own = text && sliders.find(({ path }) => text.includes(path));
    const place = own ? own.message : $("message");
    $("message").hidden = true;
    if (text) { place.textContent = text; place.hidden = false; }
  }

  // --- sliders -----------------------------------------------------------------------------------------------
  const sliders = data.sliders.map((one) => {
    const box = [...document.querySelectorAll(".slider")].find((b) => b.dataset.path === one.path);
    const range = box.querySelector("input[type=range]"), exact = box.querySelector("input[type=number]"), message = box.querySelector(".message");
    const { low, high } = one;
    const log = low > 0 && high / low > 50;
    const at = (v) => 1000 * (log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low || 1));
    const from = (k) => +(log ? low * (high / low) ** (k / 1000) : low + (high - low) * k / 1000).toPrecision(5);
    const put = (v) => {
      exact.value = String(v);
      range.value = String(Math.max(0, Math.min(1000, at(v))) || 0);
      range.setAttribute("aria-valuetext", `${v} ${one.unit}`);
    };
    box.querySelector(".unit").textContent = one.unit;
    exact.title = range.title = `Range ${low} to ${high}, limits ${one.limits} ${one.unit}${one.note ? `; ${one.note}` : ""}`;
    const set = (v) => { if (v === one.value) delete values[one.path]; else values[one.path] = v; want(); };
    range.addEventListener("input", () => { const v = from(+range.value); exact.value = String(v); range.setAttribute("aria-valuetext", `${v} ${one.unit}`); set(v); });
    exact.addEventListener("change", () => { if (exact.value === "") { put(one.value); set(one.value); return; } const v = +exact.value; put(v); set(v); });
    const reset = () => { put(one.value); delete values[one.path]; };
    box.querySelector(".reset").addEventListener("click", () => { reset(); want(); });
    put(one.value);
    return { path: one.path, message, reset };
  });
  $("sliders").addEventListener("submit", (event) => event.preventDefault());
  $("reset-all").addEventListener("click", () => { for (const one of sliders) one.reset(); want(); });
  ["band-low", "band-high"].forEach((id, k) => {
    $(id).value = String(band[k]);
    $(id).addEventListener("change", () => { band[k] = $(id).value === "" ? NaN : +$(id).value; want(true); });
  });
  $("save").addEventListener("click", async () => {
    try {
      const { file } = await ask("/save", { values });
      $("saved").replaceChildren("Wrote ", cell("code", file), ".");
      complain("");
    } catch (error) { complain(error.message); }
  });
  let timer;
  const rebuild = () => { clearTimeout(timer); timer = setTimeout(build, 120); };
  addEventListener("resize", rebuild);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", rebuild);
  build();
  fill();
  requestAnimationFrame(() => setTimeout(() => { document.body.dataset.ready = "true"; })); // painted
})();
