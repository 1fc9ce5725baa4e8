// The site in a browser: every scene plays, gauges are the native program's, and what a user does has its effect.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Stage, browse, pause, program, serve, until } from "./stage.mjs";
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

/** A scene that no site has. */
const mine = `[run]
until_s = 5

[gas]
size = [10, 10]

[[gas.species]]
name = "balls"
count = 40
radius = 0.2
mass = 1
temperature = 1
`;

/** Another, with files. */
const river = `[run]
until_s = 60

[terrain.file]
path = "dem.tif"

[flood]
spacing_m = 10

[[flood.inflow]]
name = "spring"
at = [400300, 299950]
discharge_m3_per_s = { csv = "spring.csv" }

[[flood.obstacle]]
name = "house"
file = "house.csv"
`;
const riverFiles = [
  ["dem.tif", geotiff(60, 80, 10, (column, row) => 0.02 * (column - 30) ** 2 - 0.1 * row + 20)],
  ["spring.csv", text("time_s,discharge_m3_per_s\n0,400\n60,400\n")],
  ["house.csv", text("x,y\n400280,299580\n400320,299580\n400320,299620\n400280,299620\n")],
];

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
  ["gas/atmosphere", { "run.until_s": 60, seed: 5 }, 0],
  ["gas/brownian", { "run.until_s": 80, seed: 5 }, 0],
  ["gas/free-expansion", { "run.until_s": 4, seed: 5 }, 0],
  ["gas/granular", { "run.until_s": 30, seed: 5 }, 0],
  ["gas/mixing", { "run.until_s": 10, seed: 5 }, 0],
  ["gas/million", { "run.until_s": 0.02, "gas.species.0.count": 20000 }, 0],
  ["flood/dam-break", { "flood.spacing_m": 8, "run.until_s": 2 }, 1e-6],
  ["flood/cuboid", { "run.until_s": 2 }, 1e-6],
  ["dew/pane", { "dew.spacing_m": 0.006, "run.until_s": 0.2 }, 1e-6],
  ["flood/dam-break", { "flood.spacing_m": 8, "run.until_s": 2 }, 1e-4, "gpu"],
  ["flood/valley", { "flood.spacing_m": 20, "run.until_s": 60 }, 1e-4, "gpu"],
  ["flood/cuboid", { "run.until_s": 2 }, 1e-4, "gpu"],
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

onPage("a scene without a link leaves no other in the address", "#gas/maxwell?seed=3", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  await stage.drop([["mine.toml", text(mine)]]);
  await stage.until("it plays", (state) => state.error || state.particles === 40);
  await until("the address names no scene", () => new URL(stage.page.url()).hash === "", 10);
  await stage.control("button", "Two gases mix").first().evaluate((element) => element.click());
  await until("the address names the next", () => new URL(stage.page.url()).hash === "#gas/mixing", 30);
});

onPage("a worker that breaks down is told, and the next scene opens", "#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  await stage.click("button", "Pause");
  await stage.until("it waits", (state) => !state.playing);
  // It ends in the midst of opening a scene, as by a panic, when it looks at the clock.
  const [worker] = stage.page.workers();
  await worker.evaluate(() => {
    Performance.prototype.now = () => {
      throw new WebAssembly.RuntimeError("unreachable");
    };
  });
  const next = () => stage.control("button", "Two gases mix").first().evaluate((element) => element.click());
  await next();
  const { error } = await stage.until("it is told", (state) => state.error && !state.opening);
  assert.match(error, /internal error/);
  await next();
  await stage.until("the next scene plays", (state) => state.link === "gas/mixing" && state.time > 0 && state.error === null);
  assert.ok(stage.errors.every((error) => error.includes("unreachable")), stage.errors.join());
  stage.errors = [];
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

/** A large raster: a valley that falls towards the south, of `columns` x `columns` cells of 2 m; heights of the first `filled` rows. */
const largeRaster = `(columns, filled) => {
  ${geotiff.toString()}
  const height = (column, row) => 0.004 * Math.abs(column - columns / 2) ** 1.5 - 0.02 * row + 100;
  return geotiff(columns, columns, 2, (column, row) => (row < filled ? height(column, row) : 0));
}`;

onPage("a large terrain is opened while the page goes on", "#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  await stage.dropMade("large.tif", largeRaster, [4096, 4096]);
  const longest = await stage.standstill();
  const state = await stage.until("water flows", (state) => state.error || (state.link === null && state.particles > 100), 180);
  assert.equal(state.error, null);
  await stage.shot("large");
  // The page prepares the picture of the ground.
  const most = await longest();
  console.log(`the page stood still for ${most.toFixed(0)} ms at most`);
  assert.ok(most < 4000, `${most} ms`);
});

onPage("a scene that is still being opened gives way to the next", "#gas/million", async (stage) => {
  await stage.until("it is being opened", (state) => state.opening);
  await pause(1000);
  assert.ok((await stage.state()).opening, "it opened too soon for this test");
  const begun = performance.now();
  await stage.page.evaluate(() => (location.hash = "#gas/mixing"));
  await stage.until("the next scene plays", (state) => state.link === "gas/mixing" && state.time > 0, 15);
  console.log(`the next scene played after ${((performance.now() - begun) / 1000).toFixed(1)} s`);
});

onPage("a terrain larger than a page takes is refused with what to do", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  await stage.dropMade("huge.tif", largeRaster, [6000, 0]);
  const { error } = await stage.until("it is told", (state) => state.error);
  assert.match(error, /6000 x 6000 cells, more than the 25 million.*terrain clip.*open it with the program/);
});

onPage("a scene file that is dropped is opened", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  await stage.drop([["mine.toml", text(mine)]]);
  const state = await stage.until("it plays", (state) => state.error || state.particles === 40);
  assert.equal(state.error, null);
});

/** A room with a cold solid whose surface stands in a file. */
const bottle = `[run]
until_s = 1

[dew]
size_m = [0.1, 0.1, 0.1]
spacing_m = 0.01
air = { temperature_c = 20.0, relative_humidity = 0.6 }

[[dew.solid]]
name = "bottle"
shape = { mesh = { path = "bottle.stl", unit = "cm" } }
position_m = [0.05, 0.05, 0.05]
material = "glass"
temperature_c = 5.0
`;

/** The surface of a cube as an STL file in text. */
function cube(from, to) {
  const corner = (index) => [0, 1, 2].map((axis) => ((index >> axis) & 1 ? to : from)).join(" ");
  const sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const facet = (corners) => `facet normal 0 0 0\nouter loop\n${corners.map((index) => `vertex ${corner(index)}\n`).join("")}endloop\nendfacet\n`;
  return `solid cube\n${sides.map(([a, b, c, d]) => facet([a, b, c]) + facet([a, c, d])).join("")}endsolid cube\n`;
}

onPage("a solid's mesh is dropped with its scene", "?backend=cpu", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  await stage.drop([["mine.toml", text(bottle)], ["bottle.stl", text(cube(-2, 2))]]);
  const state = await stage.until("it plays", (state) => state.error || state.time > 0, 120);
  assert.equal(state.error, null);
  await stage.shot("mesh");
});

for (const order of ["before", "after"]) {
  onPage(`a scene is opened with the files dropped ${order} it`, "", async (stage) => {
    await stage.until("the first page", (state) => !state.opening);
    const scene = ["mine.toml", text(river)];
    await stage.drop(order === "before" ? [...riverFiles, scene] : [scene, ...riverFiles]);
    const state = await stage.until("water flows", (state) => state.error || state.particles > 60, 120);
    assert.equal(state.error, null);
    assert.ok("house.force_east_N" in state.gauges, Object.keys(state.gauges).join());
    // Its files are there for a restart too.
    await stage.click("button", "Restart");
    await stage.until("it plays again", (again) => again.error || (again.time > 0 && again.time < state.time), 60);
    assert.equal((await stage.state()).error, null);
  });
}

onPage("dropped files that a page does not read are refused by name", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  await stage.drop([["bottle.stl", text("solid")]]);
  const { error } = await stage.until("the mesh alone is refused", (state) => state.error);
  assert.match(error, /bottle\.stl.*GeoTIFF/);
  await stage.page.evaluate(() => {
    Object.defineProperty(Blob.prototype, "size", { get: () => 600 * 2 ** 20 });
    Blob.prototype.arrayBuffer = () => {
      throw new Error("it was read");
    };
  });
  await stage.drop([["large.tif", text("II")]]);
  const large = await stage.until("the large file is refused", (state) => state.error?.includes("large.tif"));
  assert.match(large.error, /at most 512 MB/);
});

onPage("a scene that names a file that was not dropped with it says so", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  await stage.drop([["mine.toml", text(river)]]);
  const terrain = await stage.until("the terrain is missed", (state) => state.error);
  assert.match(terrain.error, /dem\.tif.*dropped together/);
  await stage.drop([["mine.toml", text(river)], riverFiles[0]]);
  const table = await stage.until("the table is missed", (state) => state.error && !state.error.includes("dem.tif"));
  assert.match(table.error, /(spring|house)\.csv.*dropped together/);
});

onPage("a table and the changed scene are downloaded", "#gas/maxwell?seed=3", async (stage) => {
  await stage.until("it plays", (state) => state.time > 1);
  const download = async (name) => {
    const file = stage.page.waitForEvent("download", { timeout: 60_000 });
    await stage.control("button", name).first().evaluate((element) => element.click());
    return file.then(async (file) => [file.suggestedFilename(), readFileSync(await file.path(), "utf8")]);
  };
  const [table, rows] = await download("Save plot 1 as a table");
  assert.match(table, /^gas-maxwell-.*\.csv$/);
  assert.ok(rows.trim().split("\n").length > 2 && rows.includes(","), rows.slice(0, 200));
  const [scene, written] = await download("Save the scene as changed");
  assert.equal(scene, "gas-maxwell-changed.toml");
  assert.match(written, /^seed = 3$/m);
});

onPage("a slider and a number are set by their elements, as a screen reader does", "?backend=cpu#flood/dam-break?flood.spacing_m=4", async (stage) => {
  const gauge = "water.total_inflow_m3";
  await stage.until("it plays", (state) => state.time > 0.2);
  const slider = stage.control("slider", "Rain, mm/h").first();
  await slider.waitFor({ state: "attached" });
  const described = await slider.evaluate((element) => {
    element.focus();
    element.value = String(0.6 * Number(element.getAttribute("aria-valuemax")));
    element.dispatchEvent(new Event("input", { bubbles: true }));
    return [element.getAttribute("aria-valuemin"), element.tabIndex, document.activeElement === element];
  });
  assert.deepEqual(described, ["0", 0, true]);
  await stage.until("it rains", (state) => state.gauges[gauge] > 0, 90);
  await until("the element says so", async () => Number(await slider.getAttribute("aria-valuenow")) > 0, 10);
  const number = stage.control("spinbutton", "Rain, mm/h").first();
  await number.evaluate((element) => {
    element.value = "0";
    element.dispatchEvent(new Event("change", { bubbles: true }));
  });
  await until("the number is set", async () => Number(await slider.getAttribute("aria-valuenow")) === 0, 20);
});

onPage("a list of keys has none that a page lacks", "#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  await stage.click("button", "Help");
  await stage.control("note", "play and pause").first().waitFor({ state: "attached" });
  assert.equal(await stage.control("note", "start and end a film").count(), 0);
});

test("the first picture of a gas is there within 3 s", { timeout: 120_000 }, async () => {
  const times = [];
  // Other work on this machine may hold up one load; each has an empty cache.
  while (times.length < 5 && !(Math.min(...times) <= 3)) {
    const stage = await Stage.open(browser, "about:blank");
    await stage.page.addInitScript(() => {
      const look = () => {
        const isThere = window.corpuscle && JSON.parse(window.corpuscle.state()).time !== null;
        if (isThere) requestAnimationFrame(() => (window.firstPicture = performance.now() / 1000));
        else requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    });
    await stage.page.goto(`${address}/app/#gas/maxwell`);
    times.push(await until("the first picture", () => stage.page.evaluate(() => window.firstPicture).catch(() => null)));
    await stage.close();
  }
  console.log(`first picture of gas/maxwell after ${times.map((time) => time.toFixed(2)).join(", ")} s`);
  assert.ok(Math.min(...times) <= 3, times.join());
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

onPage("a phone turns, pans and zooms by fingers", "#gas/argon", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  const box = await stage.box("img", "Picture of the scene");
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const camera = async () => (await stage.state()).camera;
  const start = await camera();
  assert.deepEqual([start.turn, start.shift, start.zoom], [[0, 0], [0, 0, 0], 1]);
  await stage.touch([[[x - 40, y], [x + 60, y + 20]]]);
  const turned = await stage.until("one finger turns", (state) => Math.abs(state.camera.turn[0]) > 0.1);
  assert.deepEqual([turned.camera.shift, turned.camera.zoom], [start.shift, 1]);
  await stage.touch([[[x - 30, y], [x - 90, y]], [[x + 30, y], [x + 90, y]]]);
  const zoomed = await stage.until("fingers that part zoom", (state) => state.camera.zoom > 1.5);
  assert.deepEqual(zoomed.camera.turn, turned.camera.turn);
  await stage.touch([[[x - 30, y - 40], [x - 30, y + 60]], [[x + 30, y - 40], [x + 30, y + 60]]]);
  const moved = (state) => Math.hypot(...state.camera.shift.map((at, axis) => at - zoomed.camera.shift[axis])) > 0;
  const panned = await stage.until("two fingers pan", moved);
  assert.ok(Math.abs(panned.camera.zoom / zoomed.camera.zoom - 1) < 0.05, `${panned.camera.zoom}`);
}, phone, { hasTouch: true });

onPage("a phone opens files, and has the rest in a menu", "", async (stage) => {
  await stage.until("the first page", (state) => !state.opening);
  const chooser = stage.page.waitForEvent("filechooser", { timeout: 30_000 });
  await stage.click("button", "Open files");
  await (await chooser).setFiles([{ name: "mine.toml", mimeType: "text/plain", buffer: Buffer.from(text(mine)) }]);
  const state = await stage.until("it plays", (state) => state.error || state.particles === 40);
  assert.equal(state.error, null);
  await stage.click("button", "More");
  for (const name of ["Show all", "Ruler", "Stopwatch", "Help"]) await stage.box("button", name);
  await stage.box("slider", "Speed");
  await stage.shot("phone-menu");
}, phone, { hasTouch: true });

test("a page within another has no panels, whatever key is pressed", { timeout: 120_000 }, async () => {
  const stage = await Stage.open(browser, `${address}/guide/introduction.html`);
  await stage.page.evaluate((address) => {
    const frame = document.createElement("iframe");
    Object.assign(frame, { src: `${address}/app/?embed#gas/maxwell`, width: 640, height: 480 });
    document.body.replaceChildren(frame);
  }, address);
  const frame = await until("the frame", () => stage.page.frames().find((frame) => frame.url().includes("embed")));
  const time = () => frame.evaluate(() => JSON.parse(window.corpuscle.state()).time).catch(() => null);
  await until("it plays", async () => (await time()) > 0.5);
  await frame.locator("#window").click({ position: { x: 320, y: 200 } });
  for (const key of ["g", "p", "l"]) await stage.page.keyboard.press(key);
  // A key that has its effect, after those that have none.
  await stage.page.keyboard.press("Space");
  await until("it waits", () => frame.evaluate(() => !JSON.parse(window.corpuscle.state()).playing));
  const picture = frame.locator('#controls [role=img][aria-label="Picture of the scene"]');
  await pause(600);
  // The page round it may draw a border in the frame's width.
  const width = await frame.evaluate(() => window.innerWidth);
  assert.ok(width > 600);
  assert.equal(await picture.evaluate((element) => element.getBoundingClientRect().width), width);
  assert.ok((await picture.evaluate((element) => element.getBoundingClientRect().height)) > 400);
  assert.deepEqual(stage.errors, []);
  await stage.close();
});

onPage("a page within another has no panels", "?embed#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 1);
  const picture = await stage.box("img", "Picture of the scene");
  assert.equal(picture.width, 640);
  await stage.shot("embedded");
}, { width: 640, height: 480 });

onPage("a picture within another page fills it", "?embed=picture#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 1);
  const picture = await stage.box("img", "Picture of the scene");
  assert.deepEqual([picture.width, picture.height], [640, 480]);
}, { width: 640, height: 480 });

// Runs in the page: keeps the device that the page is given, so that a test can take it away.
function keepDevice() {
  const request = GPUAdapter.prototype.requestDevice;
  GPUAdapter.prototype.requestDevice = async function (...described) {
    window.device = await request.apply(this, described);
    return window.device;
  };
}

test("the page survives a lost device", { timeout: 120_000 }, async () => {
  const stage = await Stage.open(browser, "about:blank");
  await stage.page.addInitScript(keepDevice);
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

test("a device that is lost twice gives way to WebGL", { timeout: 180_000 }, async () => {
  const stage = await Stage.open(browser, "about:blank");
  await stage.page.addInitScript(keepDevice);
  await stage.page.addInitScript(() => {
    // The second loss follows soon after the first, however slow this machine is.
    Date.now = () => 1e12;
  });
  await stage.page.goto(`${address}/app/#gas/maxwell?gas.species.0.count=500`);
  for (const webgpu of [true, false]) {
    const { webgpu: before } = await stage.until("it plays", (state) => state.time > 0);
    assert.equal(before, true);
    const origin = await stage.page.evaluate(() => {
      window.device.destroy();
      return performance.timeOrigin;
    });
    await until("it is opened again", async () => (await stage.page.evaluate(() => performance.timeOrigin).catch(() => origin)) !== origin);
    const again = await stage.until("it plays again", (state) => state.time > 0 && state.particles === 500);
    assert.equal(again.webgpu, webgpu);
  }
  await stage.close();
});

test("an adapter that gives no device gives way to WebGL", { timeout: 120_000 }, async () => {
  const stage = await Stage.open(browser, "about:blank");
  await stage.page.addInitScript(() => {
    GPUAdapter.prototype.requestDevice = async () => {
      throw new DOMException("no device", "OperationError");
    };
  });
  await stage.page.goto(`${address}/app/#gas/maxwell`);
  const { webgpu } = await stage.until("it plays", (state) => state.time > 0 && state.playing);
  assert.equal(webgpu, false);
  await stage.close();
});

onPage("errors that are not the program's leave it as it is", "#gas/maxwell", async (stage) => {
  await stage.until("it plays", (state) => state.time > 0);
  const said = (make) =>
    stage.page.evaluate(async (make) => {
      dispatchEvent(new ErrorEvent("error", { message: "an error", error: make ? new WebAssembly.RuntimeError("unreachable") : null }));
      return document.getElementById("said")?.textContent ?? null;
    }, make);
  assert.equal(await said(false), null);
  assert.match(await said(true), /internal error: unreachable/);
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

/** The bytes of a text. */
function text(words) {
  return new TextEncoder().encode(words);
}

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
  // All of the picture is a link, its caption is not needed.
  const picture = await stage.page.locator('.live figure[data-scene="gas/maxwell"] .picture').boundingBox();
  const marked = await stage.page.locator(".gallery .refused").evaluateAll((marks) => marks.map((mark) => mark.closest("a").hash));
  assert.deepEqual(marked.toSorted(), Object.keys(refused).map((scene) => `#${scene}`).toSorted());
  await stage.page.mouse.click(picture.x + picture.width / 2, picture.y + picture.height / 2);
  await stage.page.waitForURL(/app\/#gas\/maxwell/);
  await stage.page.goBack();
  await stage.page.setViewportSize(phone);
  await stage.shot("start-phone");
  await stage.page.setViewportSize({ width: 1360, height: 1000 });
  await stage.page.goto(`${address}/guide/window.html`);
  await stage.shot("guide");
  await stage.close();
});

test("pages of the first hour have at most two screens", { timeout: 60_000 }, async () => {
  const stage = await Stage.open(browser, `${address}/guide/introduction.html`, { width: 1920, height: 1080 });
  // Those of the first part of the list at the left.
  const first = await stage.page.locator(".guide nav h1:not(:first-child) + ul").first().locator("a").evaluateAll((links) => links.map((link) => link.href));
  assert.ok(first.length >= 8, first.join());
  for (const page of [stage.page.url(), ...first]) {
    await stage.page.goto(page);
    await stage.page.evaluate(() => Promise.all([...document.images].map((image) => image.decode())));
    const height = await stage.page.evaluate(() => document.documentElement.scrollHeight);
    assert.ok(height <= 2 * 1080, `${page}: ${height} pixels`);
  }
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

test("other sites of one origin keep what they have for use without a network", { timeout: 60_000 }, async () => {
  const stage = await Stage.open(browser, `${address}/style.css`);
  const old = `corpuscle ${address}/ 0`;
  await stage.page.evaluate((names) => Promise.all(names.map((name) => caches.open(name))), [old, "corpuscle-other", `corpuscle ${address}/other/ 0`]);
  await stage.page.goto(`${address}/app/`);
  await until("the service worker is there", () => stage.page.evaluate(() => navigator.serviceWorker.controller !== null), 60);
  const names = await until("old caches are gone", () =>
    stage.page.evaluate(async (old) => ((await caches.has(old)) ? null : caches.keys()), old));
  assert.ok(names.includes("corpuscle-other") && names.includes(`corpuscle ${address}/other/ 0`), names.join());
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
