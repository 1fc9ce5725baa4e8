// Starts the window on the canvas of this page, or says why there is none.
import load, { Page } from "./corpuscle.js";

const said = document.getElementById("said");

function tell(text) {
  said.replaceChildren(text);
}

async function start() {
  const hasWebgpu = Boolean(navigator.gpu && (await navigator.gpu.requestAdapter().catch(() => null)));
  await load({ module_or_path: new URL("corpuscle_bg.wasm", import.meta.url) });
  const canvas = document.getElementById("window");
  // Scripts of this page, and tests, ask it for what is shown.
  window.corpuscle = await Page.open(canvas, hasWebgpu).catch((error) => {
    if (!hasWebgpu || error instanceof WebAssembly.RuntimeError) throw error;
    return withoutWebgpu(canvas, error);
  });
  said.remove();
}

/** Opens the window by WebGL where a device of WebGPU is refused. */
function withoutWebgpu(canvas, error) {
  console.warn(`WebGPU gives no device, the window is drawn by WebGL: ${error}`);
  // A canvas that had a context of WebGPU gives none of WebGL.
  const other = canvas.cloneNode();
  canvas.replaceWith(other);
  document.getElementById("controls")?.remove();
  return Page.open(other, false);
}

// A program that broke down draws no more. Other errors, as of extensions of the browser, leave it as it is.
function stopped(error) {
  if (!(error instanceof WebAssembly.RuntimeError)) return;
  document.body.append(said);
  tell(`Corpuscle has stopped by an internal error: ${error.message}. Load the page again to go on.`);
}
window.addEventListener("error", (event) => stopped(event.error));
window.addEventListener("unhandledrejection", (event) => stopped(event.reason));

// Another scene in the address is opened.
window.addEventListener("hashchange", () => location.reload());

start().catch((error) => tell(`Corpuscle cannot be opened here: ${error}`));

if ("serviceWorker" in navigator) {
  navigator.serviceWorker.register("../service.js").catch(() => {});
}
