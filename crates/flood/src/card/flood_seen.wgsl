// Particles as they are seen at the time shown, which may be a little after the last step. Twin of `Flood::frame`.
#import flood_card
#import flood_ground
#import flood_outlines
#import flood_air
#import device_particles

struct Shown {
    // Time from the last step to the time shown, s.
    since: f32,
    // Distance of particles, m, where all have the same; 0 where it follows from their area.
    spacing: f32,
    // Of those in the air, m.
    drop_spacing: f32,
    unused: f32,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(3) var nodes: texture_2d<f32>;
// Outlines of obstacles: see `flood_outlines`.
@group(0) @binding(4) var<storage, read> outlines: array<u32>;
@group(0) @binding(5) var<storage, read_write> air: Air;
@group(0) @binding(6) var<uniform> shown: Shown;
@group(0) @binding(7) var<storage, read_write> seen: DeviceParticles;

fn side(number: u32) -> vec4f {
    let at = 4u * number;
    return vec4f(
        bitcast<f32>(outlines[at]),
        bitcast<f32>(outlines[at + 1u]),
        bitcast<f32>(outlines[at + 2u]),
        bitcast<f32>(outlines[at + 3u]),
    );
}

// Whether a place is inside an obstacle.
fn is_held(place: vec2f) -> bool {
    let grid = parameters.outlines;
    let at = (place - grid.corner) * grid.per_cell;
    if grid.columns == 0u || any(at < vec2f(0.0)) || any(at >= vec2f(vec2u(grid.columns, grid.rows))) {
        return false;
    }
    let cell = u32(at.y) * grid.columns + u32(at.x);
    for (var k = outlines[cell]; k < outlines[cell + 1u]; k += 3u) {
        var inside = false;
        for (var number = outlines[k + 1u]; number < outlines[k + 2u]; number++) {
            inside = inside != crosses(place, side(number));
        }
        if inside {
            return true;
        }
    }
    return false;
}

fn on_ground(particle: Particle) -> DeviceParticle {
    var as_seen: DeviceParticle;
    if particle.outside != 0u {
        return as_seen;
    }
    // What comes into an obstacle is put back before it is shown.
    let moved = particle.place + shown.since * particle.velocity;
    let place = select(moved, particle.place, is_held(moved));
    as_seen.place = vec3f(place, ground_at(parameters, nodes, place).x + particle.depth);
    as_seen.spacing = select(sqrt(particle.volume / particle.depth), shown.spacing, shown.spacing > 0.0);
    as_seen.velocity = vec3f(particle.velocity, 0.0);
    as_seen.depth = particle.depth;
    as_seen.volume = particle.volume;
    as_seen.id = particle.id;
    return as_seen;
}

fn in_air(drop: Drop) -> DeviceParticle {
    var as_seen: DeviceParticle;
    if drop.is_up == 0u {
        return as_seen;
    }
    as_seen.place = vec3f(drop.place, drop.z);
    as_seen.spacing = shown.drop_spacing;
    as_seen.velocity = vec3f(drop.velocity, drop.w);
    as_seen.volume = drop.volume;
    as_seen.id = drop.id;
    return as_seen;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    let count = status.particles + parameters.in_air;
    if i == 0u {
        seen.count = count;
    }
    if i < status.particles {
        seen.all[i] = on_ground(particles[i]);
    } else if i < count {
        seen.all[i] = in_air(air.drops[i - status.particles]);
    }
}
