"use strict";
// Interactive curves over the series of the page. Everything here is an addition: the page says the same without it.
(() => {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const series = data.series;
  // Local times are drawn as if they were UTC: the page states the zone.
  const seconds = (text) => Date.parse(text + "Z") / 1000;
  const start = series.count ? seconds(series.start) : 0;
  const cache = new Map();

  function column(key) {
    if (cache.has(key)) return cache.get(key);
    const raw = series.columns[key];
    if (!raw) return null;
    const bytes = atob(raw.data);
    const values = new Array(series.count);
    for (let i = 0; i < series.count; i++) {
      let level = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
      if (level > 32767) level -= 65536;
      values[i] = level === -32768 ? null : (level + 32500) * raw.scale + raw.offset;
    }
    cache.set(key, values);
    return values;
  }
  const times = Array.from({ length: series.count }, (_, i) => start + i * series.step);
  const minus = (a, b) => a.map((v, i) => (v === null || b[i] === null ? null : v - b[i]));
  const { axes, date, line, shown, style } = Curves;

  const box = document.getElementById("explorer");
  const picks = { sensor: "pick-sensor", period: "pick-period", beside: "pick-beside" };
  const picked = (name) => document.getElementById(picks[name])?.value ?? "";
  let plots = [];

  function tint(u) {
    const { ctx } = u;
    ctx.save();
    ctx.fillStyle = style("--panel");
    for (const [, a, b] of data.spans) {
      const left = Math.max(u.valToPos(seconds(a), "x", true), u.bbox.left);
      const right = Math.min(u.valToPos(seconds(b), "x", true), u.bbox.left + u.bbox.width);
      if (right > left) ctx.fillRect(left, u.bbox.top, right - left, u.bbox.height);
    }
    ctx.restore();
  }

  let moving = false;
  function follow(u) {
    if (moving) return;
    moving = true;
    const { min, max } = u.scales.x;
    for (const other of plots) if (other !== u) other.setScale("x", { min, max });
    moving = false;
  }

  function plot(target, label, unit, height, lines, values, bands) {
    const width = target.clientWidth || box.clientWidth;
    return new uPlot({
      width, height, tzDate: Curves.local, axes: axes(unit ? `${label} [${unit}]` : label),
      scales: { x: { time: true } }, bands,
      cursor: { sync: { key: "report" }, drag: { x: true, y: false }, points: { size: 6 } },
      legend: { live: true },
      hooks: { ...Curves.quiet, drawClear: [tint], setScale: [(u, key) => key === "x" && follow(u)] },
      series: [Curves.time, ...lines],
    }, values, target);
  }

  function draw() {
    for (const p of plots) p.destroy();
    plots = [];
    const sensor = picked("sensor");
    const info = data.sensors[sensor];
    const seen = column(`observed/${sensor}`);
    if (!seen) return;
    const chosen = [...box.querySelectorAll("input[name=model]:checked")].map((i) => i.value)
      .filter((key) => series.columns[`${key}/${sensor}`]);
    const ghost = (label) => ({ label, stroke: "transparent", width: 0, points: { show: false }, class: "hidden" });
    const lines = [], values = [times], errors = [times], below = [];
    let bands;
    const fitted = column(`${data.main}/${sensor}`);
    const half = chosen.includes(data.main) && column(`band/${sensor}`);
    if (half) {
      // The prediction interval of the measured values, and where the errors are expected for the same reason.
      const middle = column(`expected/${sensor}`) || fitted;
      const ends = [1, -1].map((sign) => middle.map((v, i) => (v === null || half[i] === null ? null : v + sign * half[i])));
      lines.push(ghost("upper"), ghost("lower"));
      below.push(ghost("upper"), ghost("lower"));
      values.push(...ends);
      errors.push(minus(fitted, ends[1]), minus(fitted, ends[0]));
      bands = [{ series: [1, 2], fill: data.colors[data.main] + "33" }];
    }
    chosen.forEach((key) => {
      const made = column(`${key}/${sensor}`);
      const dash = key === "nominal" && key !== data.main ? [6, 4] : undefined;
      lines.push(line(data.models[key] || key, data.colors[key], info.unit, { dash }));
      values.push(made);
      below.push(line(data.models[key] || key, data.colors[key], info.difference, { dash }));
      errors.push(minus(made, seen));
    });
    const ink = style("--observed");
    lines.push(line(data.observed, ink, info.unit, { width: 0, paths: () => null, points: { show: true, size: 3, width: 1, stroke: ink } }));
    values.push(seen);
    plots.push(plot(document.getElementById("plot-values"), info.label, info.unit, 300, lines, values, bands));
    plots.push(plot(document.getElementById("plot-errors"), "error", info.difference, 170, below, errors, bands));
    const key = picked("beside");
    if (key) {
      const raw = series.columns[key];
      plots.push(plot(document.getElementById("plot-beside"), raw.label, raw.unit, 150,
        [line(raw.label, style("--c3"), raw.unit)], [times, column(key)]));
    }
    zoom();
  }

  function zoom() {
    const [a, b] = picked("period").split("|");
    const range = a ? { min: seconds(a), max: seconds(b) } : { min: times[0], max: times[times.length - 1] };
    for (const p of plots) p.setScale("x", range);
  }

  function resize() {
    for (const p of plots) p.setSize({ width: p.root.parentElement.clientWidth, height: p.height });
  }

  // What a link leads to is opened, with all that it is folded in.
  function unfold() {
    const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    const own = target.matches("section") ? target.querySelector(":scope > details") : null;
    for (let d = own || target.closest("details"); d; d = d.parentElement.closest("details")) d.open = true;
    target.scrollIntoView();
  }
  addEventListener("hashchange", unfold);
  unfold();

  if (box && series.count) {
    box.hidden = false;
    // Curves have no width before their appendix is open.
    const folded = box.closest("details");
    if (folded && !folded.open) folded.addEventListener("toggle", draw, { once: true });
    else draw();
    for (const name of ["sensor", "beside"]) document.getElementById(picks[name])?.addEventListener("change", draw);
    document.getElementById(picks.period).addEventListener("change", zoom);
    for (const input of box.querySelectorAll("input[name=model]")) input.addEventListener("change", draw);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
    let timer;
    addEventListener("resize", () => { clearTimeout(timer); timer = setTimeout(resize, 120); });
  }

  // Read a carpet under the pointer.
  const readout = document.getElementById("carpet-readout");
  for (const image of document.querySelectorAll(".carpet-picture img")) {
    const sensor = image.closest(".carpet").dataset.sensor;
    const { model, days } = image.dataset;
    image.addEventListener("pointermove", (event) => {
      const place = image.getBoundingClientRect();
      const day = Math.floor((event.clientX - place.left) / place.width * days);
      const hour = 24 * (1 - (event.clientY - place.top) / place.height);
      const midnight = Math.floor(start / 86400) * 86400;
      const i = Math.round((midnight + day * 86400 + hour * 3600 - start) / series.step);
      const made = column(`${model}/${sensor}`), seen = column(`observed/${sensor}`);
      if (!made || i < 0 || i >= series.count) return;
      const error = made[i] === null || seen[i] === null ? null : made[i] - seen[i];
      const info = data.sensors[sensor];
      readout.textContent = `${info.label}, ${data.models[model]}, ${date(times[i])}: ` +
        (error === null ? "no value" : `${error > 0 ? "+" : ""}${shown(error, 2)} ${info.difference}`);
    });
  }

  // Mark the section being read in the contents; open everything for print.
  const links = new Map([...document.querySelectorAll(".contents a")].map((a) => [a.hash.slice(1), a]));
  const watch = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      for (const a of links.values()) { a.classList.remove("here"); a.removeAttribute("aria-current"); }
      links.get(entry.target.id)?.classList.add("here");
      links.get(entry.target.id)?.setAttribute("aria-current", "location");
    }
  }, { rootMargin: "-20% 0px -70% 0px" });
  for (const section of document.querySelectorAll("main > section")) watch.observe(section);
  addEventListener("beforeprint", () => { for (const d of document.querySelectorAll("main details")) d.open = true; });
})();
