"use strict";
// The engine in a worker: it gets the module and the files once, then values, and answers with records and findings.
let engine;
const bytes = (start, length) => new Uint8Array(engine.memory.buffer, start, length);
const text = (start, length) => new TextDecoder().decode(bytes(start, length));
// After a trap within a call that holds what it reads, the module has no message.
function message() {
  try { return text(engine.message(), engine.message_length()); } catch { return ""; }
}
const require = (code) => { if (code) throw new Error(message()); };
async function load({ module, files }) {
  engine = (await WebAssembly.instantiate(module)).exports;
  files.forEach((file, k) => bytes(engine.reserve(k, file.length), file.length).set(file));
  require(engine.load());
  return {};
}
function run(values) {
  require(engine.reset());
  for (const [position, value] of values) require(engine.set(position, value));
  const since = performance.now();
  require(engine.run());
  const took = performance.now() - since;
  const records = new Float64Array(engine.memory.buffer, engine.records(), engine.records_length()).slice();
  return { records, took, findings: JSON.parse(text(engine.findings(), engine.findings_length())) };
}
onmessage = async ({ data }) => {
  try {
    const answer = data.module ? await load(data) : run(data.values);
    postMessage(answer, answer.records ? [answer.records.buffer] : []);
  } catch (error) {
    const trap = error instanceof WebAssembly.RuntimeError || error instanceof RangeError; // the memory stays as it is: the page starts another worker
    let why = error.message;
    if (trap && engine) why = `${message() || "the engine has stopped"} (${why})`;
    postMessage({ refused: why, trap });
  }
};
