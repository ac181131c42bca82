"use strict";
// What all interactive curves share: axes, dates and lines for uPlot. Local times are drawn as if they were UTC.
const Curves = (() => {
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const shown = (v, digits) => (v === null || v === undefined ? "–" : v.toFixed(digits).replace("-", "−"));
  const two = (n) => String(n).padStart(2, "0");
  const months = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
  function date(t) {
    const d = new Date(t * 1000);
    return `${d.getUTCDate()} ${months[d.getUTCMonth()]} ${two(d.getUTCHours())}:${two(d.getUTCMinutes())}`;
  }
  function axes(label) {
    const ink = style("--soft");
    const lines = { stroke: style("--hair"), width: 1 };
    const marks = { stroke: style("--rule"), width: 1, size: 5 };
    const font = `11px ${style("--sans")}`;
    const values = (_, splits, __, ___, step) => splits.map((t) => {
      const d = new Date(t * 1000);
      const day = `${d.getUTCDate()} ${months[d.getUTCMonth()]}`;
      const clock = `${two(d.getUTCHours())}:${two(d.getUTCMinutes())}`;
      return step >= 86400 ? day : d.getUTCHours() + d.getUTCMinutes() === 0 ? `${clock}\n${day}` : clock;
    });
    return [
      { stroke: ink, grid: lines, ticks: marks, font, values, space: 64 },
      { stroke: ink, grid: lines, ticks: marks, font, label, labelFont: font, labelSize: 18, size: 52,
        values: (_, splits) => splits.map((v) => String(+v.toFixed(6)).replace("-", "−")) },
    ];
  }
  const line = (label, stroke, unit, more = {}) => ({
    label, stroke, width: 1.4, points: { show: false }, spanGaps: false,
    value: (_, v) => (v === null || v === undefined ? "–" : `${shown(v, 2)} ${unit}`), ...more,
  });
  const time = { label: "time", value: (_, t) => (t === null ? "–" : date(t)) };
  // Where the cursor is in no curve, the legend has names without values.
  const idle = (u) => u.root.classList.toggle("idle", u.legend.idx === null || u.legend.idx === undefined);
  const quiet = { ready: [idle], setLegend: [idle] };
  const local = (t) => new Date(t * 1000);
  return { axes, date, line, local, quiet, shown, style, time };
})();
