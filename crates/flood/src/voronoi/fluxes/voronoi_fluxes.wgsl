// Flux through each face, as if every cell had the water for it: see `fluxes/mod.rs`. `voronoi_kept.wgsl` bounds it by the water of the cells.
#import declared
#import voronoi_differences
#import voronoi_faces
#import voronoi_riemann
#import voronoi_boundaries
#import time_steps

// Thrust of the ground between a cell's centroid and the face, of the difference to the other side, and of the cell itself, per length. `over_bed` is the depth
// over the face's bed, `level` that of the side above the face's bed. As in `between` of `fluxes/mod.rs`, put so that large numbers do not cancel: all
// differences are 0 to the bit in a level lake.
fn thrust_on(at: AtFace, own: f32, over_bed: f32, level: f32, other_over_bed: f32) -> f32 {
    let of_ground = (at.depth + over_bed) * (over_bed - level) + (at.depth + own) * at.higher;
    let of_other = (other_over_bed - over_bed) * (other_over_bed + over_bed);
    return parameters.gravity * (0.5 * of_ground + 0.25 * of_other);
}

// Components `[east, north]` of what goes across and along a face.
fn turned_back(across_along: vec2f, normal: vec2f) -> vec2f {
    let tangent = vec2f(-normal.y, normal.x);
    return across_along.x * normal + across_along.y * tangent;
}

// Levels are above that of the first cell. The bed at the face is the higher of the two, but not above the lower level (Chen & Noelle 2017, equations 2.12 to
// 2.16).
fn between(face: Face, here: Water, there: Water) -> Flux {
    let length = length(face.normal);
    let normal = face.normal / length;
    let level = higher(here, there, face.rise);
    let a = seen(
        here, there, 0.0, slopes[face.first], differences(here, there, face.rise), face.between, face.offset, normal
    );
    let b = seen(
        there, here, level, slopes[face.second], differences(there, here, -face.rise), -face.between, face.offset, normal
    );
    let bed = min(max(a.level - a.depth, b.level - b.depth), min(a.level, b.level));
    let above_a = a.level - bed;
    let above_b = b.level - bed;
    let depth_a = max(min(a.depth, above_a), 0.0);
    let depth_b = max(min(b.depth, above_b), 0.0);
    let found = hll(vec2f(depth_a, a.across), vec2f(depth_b, b.across));
    let along = select(b.along, a.along, found.x > 0.0);
    let thrust = vec2f(
        thrust_on(a, here.depth, depth_a, above_a, depth_b), thrust_on(b, there.depth, depth_b, above_b, depth_a)
    );
    let carried = length * turned_back(vec2f(found.y, found.x * along), normal);
    return Flux(carried, thrust, length * found.x, 0u);
}

fn over_border(face: Face, here: Water) -> Flux {
    let border = borders[face.border];
    if here.depth <= 0.0 && !may_bring(border) {
        return Flux(vec2f(0.0), vec2f(0.0), 0.0, 0u);
    }
    let length = length(face.normal);
    let normal = face.normal / length;
    var at = at_side(here, normal);
    if border.kind == WALL {
        at = at_wall(here, slopes[face.first], face.between, face.offset, normal);
    }
    let found = through_border(border, beyond[face.border], at, here.shift);
    return Flux(length * turned_back(found.carried, normal), vec2f(found.thrust, 0.0), length * found.volume, 0u);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.faces {
        return;
    }
    let near = near_of_face(id.x);
    if !is_needed(near) {
        return;
    }
    let face = faces[id.x];
    let here = water[face.first];
    var flux = Flux(vec2f(0.0), vec2f(0.0), 0.0, 0u);
    if face.second == NONE {
        flux = over_border(face, here);
    } else {
        let there = water[face.second];
        if here.depth > 0.0 || there.depth > 0.0 {
            flux = between(face, here, there);
        }
    }
    flux.near = near;
    fluxes[id.x] = flux;
}
