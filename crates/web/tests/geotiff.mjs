// A GeoTIFF of heights in 32 bits, not compressed, in metres of EPSG:27700.

/** The bytes of a raster of `columns` x `rows` cells of a size, m; `height` gives the height of a cell. */
export function geotiff(columns, rows, cell, height) {
  const heights = new Float32Array(columns * rows);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) heights[row * columns + column] = height(column, row);
  }
  const doubles = { 33550: [cell, cell, 0], 33922: [0, 0, 0, 400_000, 300_000, 0] };
  const shorts = { 34735: [1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 27700] };
  const entries = [
    [256, 3, 1, columns], [257, 3, 1, rows], [258, 3, 1, 32], [259, 3, 1, 1], [262, 3, 1, 1], [273, 4, 1, 0], [277, 3, 1, 1], [278, 3, 1, rows],
    [279, 4, 1, heights.byteLength], [339, 3, 1, 3], [33550, 12, 3, 0], [33922, 12, 6, 0], [34735, 3, shorts[34735].length, 0],
  ];
  const directory = 8;
  let next = directory + 2 + 12 * entries.length + 4;
  next += next % 8;
  const place = {};
  for (const [tag, values, width] of [[33550, doubles[33550], 8], [33922, doubles[33922], 8], [34735, shorts[34735], 2]]) {
    place[tag] = next;
    next += values.length * width;
    next += (8 - (next % 8)) % 8;
  }
  place[273] = next;
  const view = new DataView(new ArrayBuffer(next + heights.byteLength));
  view.setUint16(0, 0x4949);
  view.setUint16(2, 42, true);
  view.setUint32(4, directory, true);
  view.setUint16(directory, entries.length, true);
  entries.forEach(([tag, type, count, value], number) => {
    const at = directory + 2 + 12 * number;
    view.setUint16(at, tag, true);
    view.setUint16(at + 2, type, true);
    view.setUint32(at + 4, count, true);
    if (place[tag]) view.setUint32(at + 8, place[tag], true);
    else if (type === 3) view.setUint16(at + 8, value, true);
    else view.setUint32(at + 8, value, true);
  });
  for (const tag of [33550, 33922]) doubles[tag].forEach((value, number) => view.setFloat64(place[tag] + 8 * number, value, true));
  shorts[34735].forEach((value, number) => view.setUint16(place[34735] + 2 * number, value, true));
  heights.forEach((value, number) => view.setFloat32(place[273] + 4 * number, value, true));
  return new Uint8Array(view.buffer);
}
