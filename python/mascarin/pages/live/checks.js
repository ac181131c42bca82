"use strict";
// What the page says of its own runs, as `mascarin run` does: balances, temperatures without a cause, steps that are too long.
const Checks = (() => {
  const small = (v) => v.toExponential(1).replace("-", "−");
  function balances({ closed, humid }, { closure, vapour }) {
    const lines = [];
    if (!(closure <= closed)) lines.push(["energy", `The energy balance does not close: the heat stored and the heat that flowed in differ by ${small(closure)} of all heat exchanged, expected ${small(closed)} at most. Do not use these results.`]);
    if (humid && !(vapour.closure <= closed)) lines.push(["vapour", `The vapour balance does not close: it differs by ${small(vapour.closure)} of all vapour exchanged, expected ${small(closed)} at most. Do not use these humidities.`]);
    if (humid && vapour.condensed > 0.01 * vapour.exchanged) lines.push(["saturated", `The air of zones was saturated: ${vapour.condensed.toPrecision(3)} kg of vapour condensed.`]);
    if (humid && vapour.corrected > 0) lines.push(["corrected", `The time step is too long for the vapour of the air in ${vapour.corrected} steps.`]);
    return lines;
  }
  function causes({ outlier, out_of_range }, when) {
    const lines = out_of_range.map(({ place, law, steps, first }) => ["range", `${place}: its law of ${law} is used where it does not hold, in ${steps} steps, first in that from ${when(first)}.`]);
    if (outlier) lines.unshift(["cause", `${outlier.place}: ${outlier.temperature.toFixed(1)} °C in the step from ${when(outlier.step)} lies beyond all that acts on it (${outlier.bound.toFixed(1)} °C). Do not use these results; a shorter time step may help.`]);
    return lines;
  }
  function unmelted({ layers, nothing }, column) {
    return layers.flatMap(({ name, temperature, fraction }) => {
      const liquid = column(fraction), warm = column(temperature);
      let low = Infinity, high = -Infinity, cold = Infinity, hot = -Infinity;
      for (let r = 0; r < liquid.length; r++) {
        low = Math.min(low, liquid[r]); high = Math.max(high, liquid[r]);
        cold = Math.min(cold, warm[r]); hot = Math.max(hot, warm[r]);
      }
      return high - low >= nothing ? [] : [["unmelted", `${name}: stayed ${liquid[0] < 0.5 ? "solid" : "liquid"}, ${cold.toFixed(2)} to ${hot.toFixed(2)} °C on the mean: its latent heat has no effect in this run.`]];
    });
  }
  // Root mean square of the differences of an air temperature from step to step, of the order of the scheme.
  function bends({ airs, order, share, large, first }, column) {
    return Object.entries(airs).flatMap(([zone, k]) => {
      let series = column(k).slice(first);
      for (let n = 0; n < order; n++) series = series.slice(1).map((v, r) => v - series[r]);
      const error = share * Math.sqrt(series.reduce((sum, v) => sum + v * v, 0) / series.length);
      return error >= large ? [["step", `Zone ${zone}: the time step is too long for its air, whose temperature is wrong by about ${error.toPrecision(1)} K.`]] : [];
    });
  }
  const all = (checks, findings, column, when) => [...balances(checks, findings), ...causes(findings, when), ...unmelted(checks, column), ...bends(checks, column)].map(([, line]) => line);
  return { all };
})();
