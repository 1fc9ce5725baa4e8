// Runs the physics beside the page, which sends the program as its first message.
import load, { serve } from "./corpuscle.js";

// The page hears of errors only: a promise that fails is one.
self.addEventListener("unhandledrejection", (event) => self.reportError(event.reason));

self.onmessage = async ({ data }) => {
  self.onmessage = null;
  await load({ module_or_path: data });
  serve();
};
