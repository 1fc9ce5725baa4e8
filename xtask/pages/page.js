// Starts the window on the canvas of this page, or says why there is none.
import load, { Page } from "./corpuscle.js";

const said = document.getElementById("said");

function tell(text) {
  said.replaceChildren(text);
}

async function start() {
  const hasWebgpu = Boolean(navigator.gpu && (await navigator.gpu.requestAdapter().catch(() => null)));
  await load({ module_or_path: new URL("corpuscle_bg.wasm", import.meta.url) });
  // Scripts of this page, and tests, ask it for what is shown.
  window.corpuscle = await Page.open(document.getElementById("window"), hasWebgpu);
  said.remove();
}

// A program that broke down draws no more.
window.addEventListener("error", (event) => {
  document.body.append(said);
  tell(`Corpuscle has stopped by an internal error: ${event.message}. Load the page again to go on.`);
});

// Another scene in the address is opened.
window.addEventListener("hashchange", () => location.reload());

start().catch((error) => tell(`Corpuscle cannot be opened here: ${error}`));

if ("serviceWorker" in navigator) {
  navigator.serviceWorker.register("../service.js").catch(() => {});
}
