// A site that is served, and a browser that opens it: what the tests share.
import { createReadStream, existsSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const root = fileURLToPath(new URL("../../../", import.meta.url));

/** The folder of the site: made by `cargo xtask site`. */
export const site = process.env.CORPUSCLE_SITE ?? join(root, "target/site");
/** The native program that the page is compared with. */
export const program = process.env.CORPUSCLE_PROGRAM ?? join(root, "target/release/corpuscle");
/** Where screenshots go; none are kept without it. */
export const shots = process.env.CORPUSCLE_SHOTS;
const browserPath = process.env.CORPUSCLE_CHROMIUM ?? "/usr/bin/chromium";

const types = {
  ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".png": "image/png", ".jpg": "image/jpeg",
};

/** Serves the site as a plain static host does; gives its address. */
export async function serve() {
  if (!existsSync(join(site, "app/index.html"))) throw new Error(`there is no site in ${site}: cargo xtask site`);
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname));
    const file = join(site, path.endsWith("/") ? `${path}index.html` : path);
    if (!file.startsWith(site) || !existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { "content-type": types[extname(file)] ?? "application/octet-stream" });
    createReadStream(file).pipe(response);
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  return { server, address: `http://127.0.0.1:${server.address().port}` };
}

const webgpu = [
  "--enable-unsafe-swiftshader", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader", "--use-angle=swiftshader",
];

/** Starts a browser, with WebGPU by software or without any. */
export function browse({ gpu = true } = {}) {
  const args = ["--no-sandbox", ...(gpu ? webgpu : ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])];
  return chromium.launch({ executablePath: browserPath, args });
}

/** Waits so many milliseconds. */
export const pause = (milliseconds) => new Promise((over) => setTimeout(over, milliseconds));

/** Waits until a value that is asked for repeatedly is there. */
export async function until(what, ask, seconds = 60) {
  const end = Date.now() + 1000 * seconds;
  let last;
  while (Date.now() < end) {
    last = await ask();
    if (last) return last;
    await new Promise((wait) => setTimeout(wait, 100));
  }
  throw new Error(`${what}: not within ${seconds} s`);
}

/** A page with the window. */
export class Stage {
  constructor(page) {
    this.page = page;
    this.errors = [];
    page.on("pageerror", (error) => this.errors.push(String(error)));
  }

  /** Opens an address of the site in a new page. */
  static async open(browser, url, viewport = { width: 1360, height: 840 }, options = {}) {
    const context = await browser.newContext({ viewport, ...options });
    const stage = new Stage(await context.newPage());
    await stage.page.goto(url);
    return stage;
  }

  /** What the window shows; none before it is open. */
  state() {
    return this.page.evaluate(() => (window.corpuscle ? JSON.parse(window.corpuscle.state()) : null)).catch(() => null);
  }

  /** Waits until the window's state is as wanted; gives the state. */
  async until(what, wanted, seconds) {
    let last;
    try {
      return await until(what, async () => ((last = await this.state()) && wanted(last) ? last : null), seconds);
    } catch (error) {
      throw new Error(`${error.message}; ${JSON.stringify({ ...last, gauges: undefined })} ${this.errors.join("; ")}`);
    }
  }

  /** The element that stands for a control, by its role and its name. */
  control(role, name) {
    return this.page.locator(`#controls [role=${role}][aria-label="${name}"]`);
  }

  /** Clicks a control with the pointer. */
  async click(role, name) {
    const box = await this.box(role, name);
    await this.page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  }

  async box(role, name) {
    const control = this.control(role, name).first();
    await control.waitFor({ state: "attached", timeout: 30_000 });
    return control.boundingBox();
  }

  /** Drops files on the window: names and bytes. */
  drop(files) {
    return this.page.evaluate((files) => {
      const data = new DataTransfer();
      for (const [name, bytes] of files) data.items.add(new File([new Uint8Array(bytes)], name));
      const canvas = document.getElementById("window");
      canvas.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    }, files.map(([name, bytes]) => [name, [...bytes]]));
  }

  /** Drops a file whose bytes a function makes in the page, of numbers: too large to be sent there. */
  dropMade(name, make, numbers) {
    return this.page.evaluate(([name, make, numbers]) => {
      const data = new DataTransfer();
      data.items.add(new File([eval(`(${make})`)(...numbers)], name));
      const canvas = document.getElementById("window");
      canvas.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
    }, [name, make.toString(), numbers]);
  }

  /** Begins to note how long the page's own thread is busy without a break; gives what tells the longest time so far, ms. */
  async standstill() {
    await this.page.evaluate(() => {
      let before = performance.now();
      window.standstill = 0;
      setInterval(() => {
        const now = performance.now();
        window.standstill = Math.max(window.standstill, now - before);
        before = now;
      }, 10);
    });
    return () => this.page.evaluate(() => window.standstill);
  }

  /** Moves fingers over the page, each from one point to another. */
  async touch(fingers) {
    const session = await this.page.context().newCDPSession(this.page);
    const points = (part) => fingers.map(([from, to], id) => ({ id, x: from[0] + part * (to[0] - from[0]), y: from[1] + part * (to[1] - from[1]) }));
    await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: points(0) });
    for (let step = 1; step <= 8; step += 1) {
      // A picture each, as of fingers that move.
      await pause(80);
      await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: points(step / 8) });
    }
    await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    await session.detach();
    // Until the window has drawn what they did.
    await pause(800);
  }

  async shot(name) {
    if (shots) await this.page.screenshot({ path: join(shots, `browser-${name}.png`) });
  }

  close() {
    return this.page.context().close();
  }
}
