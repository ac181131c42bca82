"use strict";
// Sliders, curves and tables of a page whose model runs in a worker.
(() => {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const $ = (id) => document.getElementById(id);
  const values = {}; // by path, where they differ from those as sent
  const band = [...data.band];
  let now = null, reference = null;

  // --- the engine: one worker, which is replaced after a trap -------------------------------------------------
  const OLD = "This browser cannot run the model: it has no WebAssembly with vectors, or this file may not use it. Open the file in a current Firefox, Chrome, Edge or Safari, or install Mascarin and use 'mascarin explore'.";
  // Five signs are the digits of four bytes, the highest first; the last bytes may be fewer.
  function bytesOf(text) {
    const digits = new Uint8Array(128), decoded = new DataView(new ArrayBuffer(4 * Math.ceil(text.length / 5)));
    [...data.alphabet].forEach((sign, digit) => { digits[sign.charCodeAt(0)] = digit; });
    for (let k = 0; k < text.length; k += 5) {
      let sum = 0;
      for (let n = k; n < k + 5; n++) sum = 85 * sum + (n < text.length ? digits[text.charCodeAt(n)] : 84);
      decoded.setUint32((4 * k) / 5, sum);
    }
    return new Uint8Array(decoded.buffer, 0, Math.floor((4 * text.length) / 5));
  }
  // `forcing.bin` as the engine reads it: bytes of differences, those of one place together, become numbers.
  function numbersOf(planes) {
    const count = data.channels.count, instants = planes.length / (8 * count);
    const file = new Uint8Array(8 + planes.length), bits = new BigUint64Array(file.buffer, 8);
    file.set(new TextEncoder().encode("MASCARIN"));
    for (let channel = 0; channel < count; channel++) {
      const first = channel * instants;
      for (let k = 0; k < 8 * instants; k++) file[8 + 8 * (first + (k % instants)) + Math.floor(k / instants)] = planes[8 * first + k];
      for (let k = first + 1; k < first + instants; k++) bits[k] += bits[k - 1];
    }
    return file;
  }
  async function unpacked(id) {
    const packed = bytesOf($(id).textContent.trim());
    $(id).remove();
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }
  let module, files, measured, worker, address;
  async function open() {
    if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function" || typeof Worker !== "function") throw new Error(OLD);
    try { module = await WebAssembly.compile(await unpacked("engine")); } catch { throw new Error(OLD); }
    const all = await unpacked("contents");
    let end = 0;
    const parts = data.sizes.map((size) => all.slice(end, (end += size)));
    files = [parts[0], parts[1], numbersOf(parts[2])];
    measured = JSON.parse(new TextDecoder().decode(parts[3]));
    address = URL.createObjectURL(new Blob([$("worker").textContent], { type: "text/javascript" }));
    await start();
  }
  function start() {
    worker = new Worker(address);
    return ask({ module, files });
  }
  function ask(content) {
    return new Promise((resolve, reject) => {
      const fail = (text, trap) => reject(Object.assign(new Error(text), { trap }));
      worker.onmessage = ({ data: answer }) => (answer.refused === undefined ? resolve(answer) : fail(answer.refused, answer.trap));
      worker.onerror = (event) => { event.preventDefault(); fail(event.message || OLD, true); };
      worker.postMessage(content);
    });
  }

  // --- times --------------------------------------------------------------------------------------------------
  const clock = new Float64Array(data.rows);
  for (let row = 0, jump = 0, base = 0, first = 0; row < data.rows; row++) {
    if (jump < data.clock.length && data.clock[jump][0] === row) [first, base] = data.clock[jump++];
    clock[row] = base + (row - first) * data.step;
  }
  const rows = [];
  for (let row = 0; row < data.rows; row += data.stride) rows.push(row);
  const times = rows.map((row) => clock[row]);
  const moment = (row) => new Date(clock[Math.min(row, data.rows - 1)] * 1000).toISOString().slice(0, 16).replace("T", " ");
  const dated = (text) => text.replace(/\bstep (\d+)/, (_, step) => `the step from ${moment(+step)}`);
  let outdoors;
  function readOutdoors() {
    const { stages, outdoors: channel } = data.channels;
    const view = new DataView(files[2].buffer, files[2].byteOffset + 8);
    const count = (data.rows - 1) * stages;
    outdoors = rows.map((row) => view.getFloat64(8 * (channel * count + Math.max(row * stages - 1, 0)), true));
  }

  // --- a run --------------------------------------------------------------------------------------------------
  const outputs = Object.fromEntries(data.outputs.map((output) => [output.name, output]));
  async function run(changed) {
    const sent = data.sliders.flatMap(({ path, positions }) => (path in changed ? positions.map(([position, weight]) => [position, weight === null ? changed[path] : weight * changed[path]]) : []));
    const { records, findings, took } = await ask({ values: sent });
    const column = (k) => Float64Array.from({ length: data.rows }, (_, row) => records[row * data.records + k]);
    const own = Object.keys(changed).length ? Checks.all(data.checks, findings, column, moment) : data.warnings.sent;
    return { records, findings, took, column, warnings: [...own, ...data.warnings.building] };
  }
  const series = (result, name) => rows.map((row) => result.records[row * data.records + outputs[name].column]);
  const nothing = () => new Array(rows.length).fill(null);

  // --- curves: one chart for each unit ------------------------------------------------------------------------
  let plots = [];
  const groups = new Map();
  for (const name of data.curves) groups.set(outputs[name].unit, [...(groups.get(outputs[name].unit) || []), name]);
  function columns(unit, names) {
    const lines = [times];
    for (const name of names) {
      lines.push(now ? series(now, name) : nothing(), series(reference, name));
      if (name in measured) lines.push(rows.map((row) => measured[name][row]));
    }
    if (unit === "°C") lines.push(outdoors);
    return lines;
  }
  // Quantity and unit of an axis.
  function label(unit, names) {
    const quantities = [...new Set(names.map((name) => outputs[name].quantity))];
    const words = quantities.length === 1 ? quantities[0] : unit === "°C" ? "Temperature" : "";
    return [words, unit].filter(Boolean).join(", ");
  }
  function build() {
    for (const { plot } of plots) plot.destroy();
    const target = $("plots"), narrow = innerWidth < 640;
    plots = [...groups].map(([unit, names], number) => {
      const lines = [Curves.time];
      names.forEach((name, k) => {
        const color = Curves.style(`--c${k % 8}`);
        lines.push(Curves.line(outputs[name].label, color, unit, { width: 1.8 }), Curves.line(`${outputs[name].label}, as sent`, color, unit, { dash: [4, 4], width: 1, class: "described" }));
        if (name in measured) lines.push(Curves.line(`${outputs[name].label}, measured`, color, unit, { dash: [1, 3], width: 1.8, class: "measured" }));
      });
      if (unit === "°C") lines.push(Curves.line("outdoors", Curves.style("--soft"), unit, { width: 1 }));
      const plot = new uPlot({
        width: target.clientWidth, height: number ? 170 : narrow ? 210 : 320, tzDate: Curves.local, axes: Curves.axes(label(unit, names)),
        scales: { x: { time: true } }, cursor: { sync: { key: "live" }, drag: { x: true, y: false } }, legend: { live: !narrow }, series: lines,
        hooks: Curves.quiet,
      }, columns(unit, names), target);
      return { plot, unit, names };
    });
  }

  // --- tables -------------------------------------------------------------------------------------------------
  const cell = (tag, words, className) => {
    const node = document.createElement(tag);
    if (words !== undefined) node.textContent = words;
    if (className) node.className = className;
    return node;
  };
  const number = (v) => (v === null || Number.isNaN(v) ? "–" : Curves.shown(v, Math.abs(v) >= 99.95 ? 0 : 1));
  function line(name, cells) {
    const tableRow = cell("tr"), head = cell("th", name);
    head.scope = "row";
    tableRow.append(head, ...cells.map((words, k) => cell("td", words, k % 2 ? "n" : "n strong")));
    return tableRow;
  }
  // Time outside of the limits: half of the two intervals beside each record.
  function discomfort(result, zone) {
    const sums = [0, 0, 0, 0], last = data.rows - 1;
    if (!result) return sums.fill(null);
    const temperature = result.column(outputs[`${zone}.operative_temperature`].column);
    for (let row = 0; row <= last; row++) {
      const hours = (data.step / 3600) * (row === 0 || row === last ? 0.5 : 1), above = temperature[row] - band[1], below = band[0] - temperature[row];
      if (above > 1e-6) { sums[0] += hours; sums[1] += above * hours; } else if (below > 1e-6) { sums[2] += hours; sums[3] += below * hours; }
    }
    return sums;
  }
  function difference(result, name) {
    let sum = 0, squares = 0, count = 0;
    measured[name].forEach((value, row) => {
      if (value === null || !result) return;
      const error = result.records[row * data.records + outputs[name].column] - value;
      sum += error; squares += error * error; count++;
    });
    return count ? [sum / count, Math.sqrt(squares / count)] : [null, null];
  }
  const pairs = (mine, theirs) => mine.flatMap((value, k) => [value, theirs[k]]);
  // Rooms that are ticked count in the sum; the name of one that is alone needs no box.
  const uncounted = new Set(data.uncounted);
  function tick(zone) {
    const label = cell("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = !uncounted.has(zone);
    box.dataset.zone = zone;
    box.addEventListener("change", () => {
      if (box.checked) uncounted.delete(zone); else uncounted.add(zone);
      fillComfort();
      document.querySelector(`#comfort input[data-zone="${CSS.escape(zone)}"]`).focus();
    });
    label.append(box, ` ${zone.replaceAll("_", " ")}`);
    return label;
  }
  function fillComfort() {
    if (!data.rooms.length) return;
    const several = data.rooms.length > 1, counted = data.rooms.filter((zone) => !uncounted.has(zone));
    const hours = Object.fromEntries(data.rooms.map((zone) => [zone, [discomfort(now, zone), discomfort(reference, zone)]]));
    const tableRows = data.rooms.map((zone) => {
      const tableRow = line(several ? "" : zone.replaceAll("_", " "), pairs(...hours[zone]).map(number));
      if (several) tableRow.firstChild.append(tick(zone));
      return tableRow;
    });
    const sum = (run) => [0, 1, 2, 3].map((k) => (run === 0 && !now ? null : counted.reduce((total, zone) => total + hours[zone][run][k], 0)));
    const last = line("sum of the ticked rooms", pairs(sum(0), sum(1)).map(number));
    last.className = "sum";
    $("comfort").tBodies[0].replaceChildren(...tableRows, ...(several ? [last] : []));
  }
  function fillEnergy() {
    const heats = (result) => [...data.flows.map(([flow, words]) => [words, result ? result.findings.into[flow] / 3.6e6 : null]), ["Stored in walls and air", result ? result.findings.stored / 3.6e6 : null]];
    const before = heats(reference), mine = heats(now);
    const most = Math.max(...[...mine, ...before].map(([, heat]) => Math.abs(heat)), 1e-9);
    $("energy").tBodies[0].replaceChildren(...mine.map(([words, heat], k) => [words, heat, before[k][1]]).filter(([, heat, was]) => heat || was).map(([words, heat, was]) => {
      const tableRow = line(words, [number(heat), number(was)]), bar = cell("span", undefined, "heat-bar"), part = cell("span", undefined, heat < 0 ? "out" : "in"), last = cell("td");
      const size = (50 * Math.abs(heat)) / most;
      part.style.left = `${heat < 0 ? 50 - size : 50}%`;
      part.style.width = `${size}%`;
      bar.append(part);
      last.append(bar);
      tableRow.append(last);
      return tableRow;
    }));
    $("closure").textContent = now ? `The balance ${now.findings.closure <= data.checks.closed ? "closes" : "does not close"}: its residual is ${now.findings.closure.toExponential(1).replace("-", "−")} of all heat exchanged.` : "";
  }
  function fill() {
    fillComfort();
    if ($("fit")) $("fit").tBodies[0].replaceChildren(...Object.keys(measured).map((name) => line(`${name}, ${outputs[name].unit.replace("°C", "K")}`, pairs(difference(now, name), difference(reference, name)).map((v) => Curves.shown(v, 2)))));
    fillEnergy();
    const lines = now ? now.warnings : [];
    $("warned").hidden = !lines.length;
    $("warnings").replaceChildren(...lines.map((words) => cell("li", words)));
    $("csv").disabled = !now;
    $("state").textContent = now ? `Simulated in ${now.took < 1 ? "less than 1" : now.took.toFixed(0)} ms.` : "No result for these values.";
  }
  function draw() {
    for (const { plot, unit, names } of plots) plot.setData(columns(unit, names), false);
    for (const { plot } of plots) {
      const { min, max } = plot.scales.x;
      plot.setScale("x", { min, max }); // keeps what was zoomed to, and fits the other axis
    }
    fill();
  }

  // --- one run at a time, the newest values next --------------------------------------------------------------
  let running = false, waiting = null;
  function want() {
    waiting = performance.now();
    if (!running) next();
  }
  async function next() {
    const since = waiting;
    waiting = null;
    running = true;
    try {
      now = await run({ ...values });
      complain("");
    } catch (error) {
      now = null;
      complain(`No result for these values: ${dated(error.message)}`);
      if (error.trap) {
        worker.terminate();
        await start().catch((again) => complain(again.message));
      }
    }
    draw();
    // After the browser has painted.
    requestAnimationFrame(() => setTimeout(() => {
      document.body.dataset.latency = (performance.now() - since).toFixed(1);
      document.body.dataset.runs = String(1 + Number(document.body.dataset.runs || 0));
    }));
    running = false;
    if (waiting !== null) next();
  }
  function complain(words) { $("message").hidden = !words; $("message").textContent = words; }

  // --- sliders ------------------------------------------------------------------------------------------------
  const sliders = data.sliders.map((slider) => {
    const box = [...document.querySelectorAll(".slider")].find((each) => each.dataset.path === slider.path);
    const range = box.querySelector("input[type=range]"), exact = box.querySelector("input[type=number]"), message = box.querySelector(".message");
    const { low, high } = slider, [lower, upper] = slider.limits;
    const log = low > 0 && high / low > 50;
    const at = (v) => 1000 * (log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low || 1));
    const from = (k) => Math.min(high, Math.max(low, +(log ? low * (high / low) ** (k / 1000) : low + ((high - low) * k) / 1000).toPrecision(5)));
    const said = (v) => range.setAttribute("aria-valuetext", `${v} ${slider.unit}`);
    const put = (v) => { exact.value = String(v); range.value = String(Math.max(0, Math.min(1000, at(v))) || 0); said(v); };
    const refuse = (words) => { message.textContent = words; message.hidden = !words; exact.toggleAttribute("aria-invalid", Boolean(words)); };
    const inside = (v) => Number.isFinite(v) && (lower === null || v >= lower) && (upper === null || v <= upper);
    function set(v) {
      if (!inside(v)) { refuse(`Found ${`${v} ${slider.unit}`.trim()}; expected ${slider.allowed}. The last value is used.`); return; }
      refuse("");
      if (v === slider.value) delete values[slider.path]; else values[slider.path] = v;
      want();
    }
    box.querySelector(".unit").textContent = slider.unit;
    exact.title = range.title = `Range ${low} to ${high}; ${slider.allowed}${slider.note ? `; ${slider.note}` : ""}`;
    range.addEventListener("input", () => { const v = from(+range.value); exact.value = String(v); said(v); set(v); });
    exact.addEventListener("change", () => { const v = exact.value === "" ? slider.value : +exact.value; put(v); set(v); });
    const reset = () => { put(slider.value); refuse(""); delete values[slider.path]; };
    box.querySelector(".reset").addEventListener("click", () => { reset(); want(); });
    if (slider.interval) {
      const mark = box.querySelector(".interval span"), ends = slider.interval.map((v) => Math.max(0, Math.min(1000, at(v))) / 10);
      mark.style.left = `${ends[0]}%`;
      mark.style.width = `${ends[1] - ends[0]}%`;
    }
    put(slider.value);
    return { reset, enable: () => { range.disabled = exact.disabled = false; } };
  });
  $("sliders").addEventListener("submit", (event) => event.preventDefault());
  $("reset-all").addEventListener("click", () => { for (const { reset } of sliders) reset(); want(); });
  if (data.rooms.length) ["band-low", "band-high"].forEach((id, k) => {
    $(id).value = String(band[k]);
    $(id).addEventListener("change", () => {
      const ends = [+$("band-low").value, +$("band-high").value];
      if ($(id).value === "" || !(ends[0] < ends[1])) { complain(`Comfort: found ${ends[0]} to ${ends[1]} °C; expected two temperatures, the lower one first.`); return; }
      band.splice(0, 2, ...ends);
      complain("");
      fill();
    });
  });

  // --- files --------------------------------------------------------------------------------------------------
  function download(name, type, words) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([words], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  }
  const stem = data.base.replace(/^.*[\\/]/, "").replace(/\.[^.]*$/, "");
  $("save").addEventListener("click", () => {
    const entries = Object.entries({ ...data.settings, ...values }).map(([path, value]) => `  ${JSON.stringify(path)}: ${value}\n`).join("");
    download(`${stem}-changed.yaml`, "text/yaml", `# ${data.title.replace(/\s+/g, " ")} with other values, by a page of Mascarin ${data.version}.\n# Put this file beside ${data.base.replace(/\s+/g, " ")}. The page: ${data.period}.\nextends: ${JSON.stringify(data.base)}\nset:${entries ? `\n${entries}` : " {}\n"}`);
  });
  $("csv").addEventListener("click", () => {
    const quoted = (words) => (/[",\n]/.test(words) ? `"${words.replaceAll('"', '""')}"` : words);
    const lines = Array.from(clock, (_, row) => [moment(row), ...data.outputs.map(({ column }) => now.records[row * data.records + column])].join(","));
    download(`${stem}.csv`, "text/csv", [["time", ...data.outputs.map(({ name, plain }) => quoted(`${name} [${plain}]`))].join(","), ...lines].join("\n") + "\n");
  });

  // --- begin --------------------------------------------------------------------------------------------------
  let timer;
  const rebuild = () => { clearTimeout(timer); timer = setTimeout(() => reference && build(), 120); };
  addEventListener("resize", rebuild);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", rebuild);
  (async () => {
    await open();
    readOutdoors();
    now = reference = await run({});
    for (const { enable } of sliders) enable();
    build();
    fill();
    requestAnimationFrame(() => setTimeout(() => { document.body.dataset.ready = "true"; })); // painted
  })().catch((error) => {
    $("unable").textContent = dated(error.message);
    $("unable").hidden = false;
    $("state").textContent = "";
    document.body.dataset.ready = "failed";
  });
  // For a look at numbers in the console of the browser.
  globalThis.mascarin = { run, data };
})();
