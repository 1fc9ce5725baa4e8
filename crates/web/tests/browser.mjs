// The site in a browser: every scene plays, gauges are the native program's, and what a user does has its effect.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Stage, browse, program, serve, until } from "./stage.mjs";
import { geotiff } from "./geotiff.mjs";

let address, server, browser;

before(async () => {
  ({ address, server } = await serve());
  browser = await browse();
});

after(async () => {
  await browser.close();
  server.close();
});

/** Runs a test with a page of the window. */
function onPage(name, link, run, viewport, options) {
  test(name, { timeout: 240_000 }, async () => {
    const stage = await Stage.open(browser, `${address}/app/${link}`, viewport, options);
    try {
      await run(stage);
      assert.deepEqual(stage.errors, []);
    } finally {
      await stage.close();
    }
  });
}

/** Gauges of the native program at the end of a scene with changes. */
function native(scene, changes) {
  const folder = mkdtempSync(join(tmpdir(), "corpuscle-browser-"));
  try {
    const sets = Object.entries(changes).flatMap(([path, value]) => ["--set", `${path}=${value}`]);
    execFileSync(program, ["run", scene, "-o", join(folder, "run"), "--backend", "cpu", "--frames", "none", ...sets], { stdio: "ignore" });
    const rows = readFileSync(join(folder, "run/gauges.csv"), "utf8").trim().split("\n").map((row) => row.split(","));
    return Object.fromEntries(rows[0].map((column, at) => [column, Number(rows.at(-1)[at])]));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

// A scene that needs a download says so.
const refused = { "flood/iowa-river": /network|download|fetch/i, "flood/chishui": /network|download|fetch/i };

test("every scene of the gallery starts and plays", { timeout: 1_800_000 }, async () => {
  const page = await Stage.open(browser, `${address}/`);
  const links = await page.page.locator(".gallery a").evaluateAll((links) => links.map((link) => link.getAttribute("href")));
  await page.close();
  assert.ok(links.length > 20, `${links.length} scenes`);
  for (const link of links) {
    const scene = link.split("#")[1];
    // Small, so that software in place of a GPU draws it soon.
    const stage = await Stage.open(browser, `${address}/${link}`, { width: 1000, height: 640 });
    try {
      if (refused[scene]) {
        const { error } = await stage.until(`${scene} is refused`, (state) => state.error);
        assert.match(error, refused[scene]);
      } else {
        const { error } = await stage.until(`${scene} plays`, (state) => state.error || (state.time > 0 && state.playing), 240);
        assert.equal(error, null, scene);
      }
      assert.deepEqual(stage.errors, [], scene);
      await stage.shot(scene.replace("/", "-"));
    } finally {
      await stage.close();
    }
  }
});

// A gas has the same bits; of floods and dew sines, exponentials and powers of a browser differ from the native ones in their last digit.
// On a GPU (here software) floods and dew are computed in single precision: velocities across the flow are small beside it.
for (const [scene, changes, allowed, backend = "cpu"] of [
  ["gas/maxwell", { "run.until_s": 5 }, 0],
  ["gas/paper-2000", { "run.until_s": 0.5 }, 0],
  ["gas/argon", { "run.until_s": 2e-10, seed: 7 }, 0],
  ["gas/piston", { "run.until_s": 60, seed: 3 }, 0],
  ["gas/effusion", { "run.until_s": 3 }, 0],
  ["flood/dam-break", { "flood.spacing_m": 8, "run.until_s": 2 }, 1e-6],
  ["dew/pane", { "dew.spacing_m": 0.006, "run.until_s": 0.2 }, 1e-6],
  ["flood/dam-break", { "flood.spacing_m": 8, "run.until_s": 2 }, 1e-4, "gpu"],
  ["flood/valley", { "flood.spacing_m": 20, "run.until_s": 60 }, 1e-4, "gpu"],
  ["dew/pane", { "dew.spacing_m": 0.006, "run.until_s": 0.2 }, 1e-5, "gpu"],
]) {
  const link = `?speed=40&backend=${backend}#${scene}?${Object.entries(changes).map(([path, value]) => `${path}=${value}`).join("&")}`;
  onPage(`gauges of ${scene} on the ${backend} are the native program's`, link, async (stage) => {
    const end = changes["run.until_s"];
    const state = await stage.until("the scene has ended", (state) => !state.playing && state.measured_at >= end, 200);
    const expected = native(scene, changes);
    assert.equal(state.measured_at, expected.time_s);
    assert.ok(state.computed_on.startsWith(`Computed on the ${backend.toUpperCase()}`), state.computed_on);
    let compared = 0;
    for (const [gauge, value] of Object.entries(expected)) {
      if (gauge === "time_s") continue;
      const here = state.gauges[gauge];
      if (Number.isNaN(value)) continue;
      const far = Math.abs(here - value) / Math.max(Math.abs(value), 1e-12);
      // The chi-squared distribution is that of a library, by the browser's own exponentials.
      const most = gauge.endsWith("p_value") ? 1e-9 : allowed;
      assert.ok(here === value || far <= most, `${gauge}: ${here}, native ${value}`);
      compared += 1;
    }
    assert.ok(compared > 3, `${compared} gauges`);
  });
}

onPage("a control is pressed by its name, as a screen reader does", "#gas/maxwell", async (stage) => {
  const { gauges } = await stage.until("it plays", (state) => state.gauges["gas.temperature"] > 0);
  const warm = gauges["gas.temperature"];
  await stage.control("button", "Heat").first().evaluate((element) => element.click());
  await stage.until("it is warmer", (state) => Math.abs(state.gauges["gas.temperature"] / warm - 1.15) < 1e-6);
  await stage.click("button", "Cool");
  await stage.until("it is as before", (state) => Math.abs(state.gauges["gas.temperature"] / warm - 1) < 1e-6);
  await stage.click("button", "Pause");
  await stage.until("it waits", (state) => !state.playing);
  await stage.shot("desktop");
});

for (const backend of ["cpu", "gpu"]) {
  onPage(`a slider changes the physics on the ${backend}`, `?backend=${backend}#flood/dam-break?flood.spacing_m=4`, async (stage) => {
    const gauge = "water.total_inflow_m3";
    const { gauges } = await stage.until("it plays", (state) => state.time > 0.2);
    assert.equal(gauges[gauge], 0);
    const box = await stage.box("slider", "Rain, mm/h");
    const { mouse } = stage.page;
    await mouse.move(box.x + 8, box.y + box.height / 2);
    await mouse.down();
    await mouse.move(box.x + 0.6 * box.width, box.y + box.height / 2, { steps: 5 });
    await mouse.up();
    await stage.until("it rains", (state) => state.gauges[gauge] > 0, 90);
    assert.match(stage.page.url(), /rain/);
    await stage.click("button", "Pause");
    const { time } = await stage.until("it waits", (state) => !state.playing);
    await new Promise((wait) => setTimeout(wait, 500));
    assert.equal((await stage.state()).time, time);
  });
}

onPage("a link restores its changes, and follows them", "#gas/maxwell?gas.species.0.count=500&seed=3", async (stage) => {
  await stage.until("it has 500 balls", (state) => state.particles === 500 && state.time > 0);
  await stage.page.evaluate(() => (location.hash = "#gas/mixing"));
  await stage.until("the other scene is open", (state) => state.link === "gas/mixing" && state.time > 0);
});

onPage("a link that is wrong is told", "#gas/none", async (stage) => {
  const { error } = await stage.until("it is told", (state) => state.error);
  assert.match(error, /gas\/none/);
});

onPage("a scene that needs more memory than a page has is refused with what to do", "#gas/maxwell?gas.species.0.count=20000000&gas.species.0.radius=0.01", async (stage) => {
  const { error } = await stage.until("it is told", (state) => state.error);
  assert.match(error, /10\.0 GB of memory, and 3\.2 GB can be had here: give fewer balls/);
});

onPage("terrain that is dropped is flooded", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  // A valley that falls towards the south.
  const height = (column, row) => 0.05 * Math.abs(column - 30) ** 1.5 - 0.1 * row + 20;
  await stage.drop([["valley.tif", geotiff(60, 80, 10, height)]]);
  const state = await stage.until("water flows", (state) => state.error || state.particles > 100, 120);
  assert.equal(state.error, null);
  await stage.shot("dropped");
  await stage.drop([["note.tif", new TextEncoder().encode("no terrain")]]);
  const { error } = await stage.until("what is none is refused", (state) => state.error);
  assert.match(error, /note\.tif/);
});

onPage("a scene file that is dropped is opened", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  const text = "[run]\nuntil_s = 5\n\n[gas]\nsize = [10, 10]\n\n[[gas.species]]\nname = \"balls\"\ncount = 40\nradius = 0.2\nmass = 1\ntemperature = 1\n";
  await stage.drop([["mine.toml", new TextEncoder().encode(text)]]);
  const state = await stage.until("it plays", (state) => state.error || state.particles === 40);
  assert.equal(state.error, null);
});

onPage("a still is downloaded", "#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  const download = stage.page.waitForEvent("download", { timeout: 60_000 });
  await stage.click("button", "Save a still");
  const file = await download;
  assert.equal(file.suggestedFilename(), "gas-maxwell.png");
  const bytes = readFileSync(await file.path());
  assert.equal(bytes.subarray(1, 4).toString(), "PNG");
  assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [1920, 1080]);
  assert.ok(bytes.length > 20_000, `${bytes.length} bytes`);
});

const phone = { width: 390, height: 844 };
onPage("a phone has the picture and one panel", "#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 1);
  const picture = await stage.box("img", "Picture of the scene");
  assert.ok(picture.width === phone.width && picture.height > 250, JSON.stringify(picture));
  await stage.shot("phone");
  await stage.click("button", "Parameters");
  await stage.box("button", "Heat");
  await stage.shot("phone-parameters");
  await stage.click("button", "Scenes");
  await stage.click("button", "Two gases mix");
  await stage.until("the other scene is open", (state) => state.link === "gas/mixing" && state.time > 0);
}, phone, { hasTouch: true });

onPage("a page within another has no panels", "?embed#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 1);
  const picture = await stage.box("img", "Picture of the scene");
  assert.equal(picture.width, 640);
  await stage.shot("embedded");
}, { width: 640, height: 480 });

test("the page survives a lost device", { timeout: 120_000 }, async () => {
  const stage = await Stage.open(browser, "about:blank");
  await stage.page.addInitScript(() => {
    const request = GPUAdapter.prototype.requestDevice;
    GPUAdapter.prototype.requestDevice = async function (...described) {
      window.device = await request.apply(this, described);
      return window.device;
    };
  });
  await stage.page.goto(`${address}/app/#gas/maxwell?gas.species.0.count=500`);
  await stage.until("it plays", (state) => state.time > 0);
  const before = await stage.page.evaluate(() => {
    window.isFirst = true;
    window.device.destroy();
    return performance.timeOrigin;
  });
  await until("it is opened again", async () => (await stage.page.evaluate(() => performance.timeOrigin).catch(() => before)) !== before);
  await stage.until("it plays again", (state) => state.time > 0 && state.particles === 500);
  await stage.close();
});

test("without WebGPU scenes play as discs and maps, by WebGL", { timeout: 240_000 }, async () => {
  const other = await browse({ gpu: false });
  for (const scene of ["gas/maxwell", "gas/argon", "flood/valley", "dew/pane"]) {
    const stage = await Stage.open(other, `${address}/app/#${scene}`);
    const { webgpu, error } = await stage.until(`${scene} plays`, (state) => state.error || (state.time > 0 && state.playing), 100);
    assert.deepEqual([webgpu, error, stage.errors], [false, null, []]);
    const frame = await until("a picture", async () => ((await drawn(stage)) > 50 ? true : null));
    assert.ok(frame);
    await stage.shot(`no-webgpu-${scene.replace("/", "-")}`);
    await stage.close();
  }
  await other.close();
});

/** How many different colours the picture of the scene has, on a grid of points. */
async function drawn(stage) {
  const box = await stage.box("img", "Picture of the scene");
  const bytes = await stage.page.screenshot({ clip: box });
  return stage.page.evaluate(async (bytes) => {
    const image = await createImageBitmap(new Blob([new Uint8Array(bytes)], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const colours = new Set();
    for (let at = 0; at < data.length; at += 4 * 7) colours.add((data[at] << 16) | (data[at + 1] << 8) | data[at + 2]);
    return colours.size;
  }, [...bytes]);
}

test("the start page has a live picture of each model", { timeout: 240_000 }, async () => {
  const stage = await Stage.open(browser, `${address}/`, { width: 1360, height: 1000 });
  await until("all are live", async () => (await stage.page.locator(".live iframe.shown").count()) === 3, 200);
  await stage.shot("start");
  await stage.page.setViewportSize(phone);
  await stage.shot("start-phone");
  await stage.page.setViewportSize({ width: 1360, height: 1000 });
  await stage.page.goto(`${address}/guide/window.html`);
  await stage.shot("guide");
  await stage.close();
});

test("the guide is searched", { timeout: 60_000 }, async () => {
  const stage = await Stage.open(browser, `${address}/guide/introduction.html`);
  const { page } = stage;
  await page.keyboard.press("/");
  await page.keyboard.type("manning roughness");
  await page.locator("#found li a").first().waitFor();
  await stage.shot("search");
  assert.match(await page.locator("#found li").first().innerText(), /manning/i);
  await page.keyboard.press("Enter");
  await page.waitForURL(/\.html#/);
  await page.locator("#search").fill("no such words <b>");
  await page.getByText("Nothing found").waitFor();
  assert.deepEqual(stage.errors, []);
  await stage.close();
});

test("after the first visit it works without a network", { timeout: 120_000 }, async () => {
  const stage = await Stage.open(browser, `${address}/app/#gas/maxwell`);
  await stage.until("it plays", (state) => state.time > 0);
  await until("the service worker has it", () => stage.page.evaluate(() => navigator.serviceWorker.controller !== null), 60);
  await stage.page.context().setOffline(true);
  await stage.page.goto(`${address}/app/?again#gas/mixing`);
  await stage.until("it plays offline", (state) => state.link === "gas/mixing" && state.time > 0);
  await stage.close();
});
