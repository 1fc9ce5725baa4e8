// What the passes read of each particle. Twins of `Column` and `Slopes` in `balanced/mod.rs`.
#import flood_neighbours
#import flood_ground

struct Column {
    place: vec2f,
    // Half a step ahead.
    velocity: vec2f,
    surface: f32,
    depth: f32,
    area: f32,
    per_h: f32,
}

// Columns as they lie in memory, sixteen bytes at a time, as `Packed`: who looks for neighbours needs the first half of those out of reach.
struct PackedColumn {
    place_area_per_h: vec4f,
    velocity_surface_depth: vec4f,
}

fn column_of(here: vec4f, water: vec4f) -> Column {
    return Column(here.xy, water.xy, water.z, water.w, here.z, here.w);
}

fn unpacked_column(packed: PackedColumn) -> Column {
    return column_of(packed.place_area_per_h, packed.velocity_surface_depth);
}

fn packed_column(column: Column) -> PackedColumn {
    let here = vec4f(column.place, column.area, column.per_h);
    return PackedColumn(here, vec4f(column.velocity, column.surface, column.depth));
}

struct Slopes {
    // Renormalisation matrix B (symmetric): xx, xy, yy.
    renormalisation: vec3f,
    // 1 for what is not of this water.
    outside: f32,
    surface: vec2f,
    ground: vec2f,
    u: vec2f,
    v: vec2f,
    // 1 at rest, 0 in motion; 1 without neighbours, 0 with enough of them: only the particle itself asks for these.
    rest: f32,
    alone: f32,
}

// Slopes as they lie in memory.
struct PackedSlopes {
    renormalisation_outside: vec4f,
    surface_and_ground: vec4f,
    u_and_v: vec4f,
    rest_and_alone: vec4f,
}

fn unpacked_slopes(packed: PackedSlopes) -> Slopes {
    let a = packed.renormalisation_outside;
    let b = packed.surface_and_ground;
    let c = packed.u_and_v;
    let d = packed.rest_and_alone;
    return Slopes(a.xyz, a.w, b.xy, b.zw, c.xy, c.zw, d.x, d.y);
}

fn packed_slopes(slopes: Slopes) -> PackedSlopes {
    return PackedSlopes(
        vec4f(slopes.renormalisation, slopes.outside),
        vec4f(slopes.surface, slopes.ground),
        vec4f(slopes.u, slopes.v),
        vec4f(slopes.rest, slopes.alone, 0.0, 0.0),
    );
}

// The depth in which two particles push each other, at most, over the smaller of theirs.
const SHARED = 3.0;

// A vector multiplied by a symmetric matrix.
fn turned(matrix: vec3f, vector: vec2f) -> vec2f {
    return vec2f(dot(matrix.xy, vector), dot(matrix.yz, vector));
}

// How much higher the water and its ground stand in the image over a periodic side.
fn step_up(mirror: Mirror, parameters: Parameters, nodes: texture_2d<f32>, place: vec2f) -> f32 {
    var higher = 0.0;
    let bounds = parameters.bounds;
    if mirror.beyond.x != 0.0 && mirror.sign.x > 0.0 {
        let west = ground_at(parameters, nodes, vec2f(bounds.x, place.y)).x;
        higher += mirror.beyond.x * (ground_at(parameters, nodes, vec2f(bounds.y, place.y)).x - west);
    }
    if mirror.beyond.y != 0.0 && mirror.sign.y > 0.0 {
        let south = ground_at(parameters, nodes, vec2f(place.x, bounds.z)).x;
        higher += mirror.beyond.y * (ground_at(parameters, nodes, vec2f(place.x, bounds.w)).x - south);
    }
    return higher;
}
