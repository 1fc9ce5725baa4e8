// Runs the physics beside the page, which sends the program as its first message.
import load, { serve } from "./corpuscle.js";

self.onmessage = async ({ data }) => {
  self.onmessage = null;
  await load({ module_or_path: data });
  serve();
};
