// What the kernels of water on the device share: numbers of the picture, and cells. Places are counted from the middle of the stage, m.
#import device_particles

struct Water {
    // The particles' origin from the middle of the stage, m, with heights as they are drawn; how many times higher those are drawn.
    shift: vec3f,
    raise: f32,
    // South-west corner of the cells, m; cells per metre.
    corner: vec2f,
    per_cell: f32,
    // Stage units a metre.
    unit: f32,
    // South-west node of the ground, m; nodes per metre.
    ground_corner: vec2f,
    ground_per_metre: vec2f,
    ground_nodes: vec2u,
    // Cells of particles on the ground. Then comes one for those in the air, and one for what is no particle.
    columns: u32,
    rows: u32,
    // Particles that there is room for.
    room: u32,
    // Foam is remembered by these bits of a particle's id.
    memory: u32,
    // The part of the foam before that is left.
    left: f32,
    unused: f32,
}

// Surface and place of a column of water: place, height, distance to its neighbours, m. Beside it its motion: velocity east and north,
// m/s, and slope of the ground.

// A particle as it is drawn: `Instance` of droplet.rs.
struct Instance {
    place: vec3f,
    radius: f32,
    normal: vec3f,
    flatness: f32,
    matter: vec4f,
}

// How far a particle looks, and its water is spread, in distances between particles.
const REACH = 2.0;
// Steeper than this no water stands.
const STEEPEST = 1.0;

// Larger than any height.
const NO_HEIGHT = 1e30;

fn of_ground(water: Water) -> u32 {
    return water.columns * water.rows;
}

// Column and row of a place.
fn cell_at(water: Water, place: vec2f) -> vec2u {
    let at = vec2u(max((place - water.corner) * water.per_cell, vec2f(0.0)));
    return min(at, vec2u(water.columns, water.rows) - 1u);
}
