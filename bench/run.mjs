// Runs the worker of the page without a browser, by node: prints the table of a run.
//
//     node bench/run.mjs target/bench LINK STEPS
import { readFileSync } from "node:fs";
import { runInNewContext } from "node:vm";

const [folder, link, steps] = process.argv.slice(2);

// Scripts of the page, which leave the core and a basis.
const page = {};
runInNewContext(`${readFileSync(`${folder}/core.js`, "utf8")}; core = BENCH_CORE;`, page);
const basis = (name) => {
  const made = { BENCH_BASES: {} };
  runInNewContext(readFileSync(`${folder}/bases/${name}.js`, "utf8"), made);
  return made.BENCH_BASES[name];
};

// The worker, with the two functions that it has from a browser.
const waiting = new Map();
const worker = { TextDecoder, TextEncoder, WebAssembly, Blob, Response, DecompressionStream, atob, performance };
worker.postMessage = ({ id, answer, error }) => {
  const { found, failed } = waiting.get(id);
  error ? failed(new Error(error)) : found(answer);
};
runInNewContext(page.core.worker, worker);
let last = 0;
const ask = (kind, request = {}) =>
  new Promise((found, failed) => {
    waiting.set(++last, { found, failed });
    worker.onmessage({ data: { id: last, kind, ...request } });
  });

await ask("load", { wasm: page.core.wasm });
const { name } = await ask("basis", { link });
await ask("hold", { basis: basis(name) });
await ask("start", { link });
const { done, error } = await ask("advance", { steps: Number(steps), budget: Infinity });
if (error || done != steps) throw new Error(error ?? `${done} of ${steps} steps`);
process.stdout.write((await ask("text", { what: "csv" })).text);
