// The core in a thread of its own: requests in, replies out, one after the other. The page makes it from a text, so that
// it works from a file, too.
"use strict";

let core = null,
  bench = 0; // address of its state

async function unpacked(base64) {
  const packed = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function output() {
  return new Uint8Array(core.memory.buffer, core.bench_output(bench), core.bench_output_length(bench)).slice();
}

const text = (bytes) => new TextDecoder().decode(bytes);

// Calls a function of the core with bytes as input.
function call(name, input = new Uint8Array(), ...others) {
  const bytes = typeof input === "string" ? new TextEncoder().encode(input) : input;
  const address = core.bench_input(bench, bytes.length);
  new Uint8Array(core.memory.buffer, address, bytes.length).set(bytes);
  let failed;
  try {
    failed = core[name](bench, ...others);
  } catch (error) {
    core.bench_failure(bench);
    const where = text(output());
    throw new Error(`the core gave up (${where || error.message}); load the page anew`);
  }
  const found = output();
  if (failed) throw new Error(text(found));
  return found;
}

function frame() {
  return new Float64Array(call("bench_frame").buffer);
}

const ANSWERS = {
  async load({ wasm }) {
    const { instance } = await WebAssembly.instantiate(await unpacked(wasm), {});
    core = instance.exports;
    bench = core.bench_new();
    core.bench_explain_failures(bench);
    return {};
  },
  async hold({ basis }) {
    return { name: text(call("bench_hold_basis", await unpacked(basis))) };
  },
  basis: ({ link }) => ({ name: text(call("bench_basis_name", link)) }),
  start: ({ link }) => ({ description: JSON.parse(text(call("bench_start", link))), frame: frame() }),
  // Steps for at most `budget` milliseconds; what was not done is not made up for.
  advance({ steps, budget }) {
    const began = performance.now();
    let done = 0,
      error = null;
    while (done < steps && performance.now() - began < budget) {
      try {
        call("bench_step", "", 1);
      } catch (failure) {
        error = failure.message;
        break;
      }
      done++;
    }
    return { done, error, spent: performance.now() - began, frame: frame() };
  },
  change({ change }) {
    call("bench_change", change);
    return { frame: frame() };
  },
  text: ({ what }) => ({ text: text(call(`bench_${what}`)) }),
};

let turn = Promise.resolve();
onmessage = ({ data: { id, kind, ...request } }) => {
  turn = turn.then(async () => {
    try {
      const answer = await ANSWERS[kind](request);
      postMessage({ id, answer }, answer.frame ? [answer.frame.buffer] : []);
    } catch (error) {
      postMessage({ id, error: error.message });
    }
  });
};
