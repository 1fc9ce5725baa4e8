// Which particles are to be halved and along which direction, and with which one each small one would best be merged. Twin of
// `Refinement::partner` and `emptiest` in `refinement.rs`. Who is near is as the last sort had it.
#import flood_refinement
#import flood_neighbours

@group(0) @binding(2) var<storage, read> status: Status;
@group(0) @binding(3) var<storage, read> particles: array<Particle>;
@group(0) @binding(4) var<storage, read> start: array<u32>;
// Place, weight and reach of each.
@group(0) @binding(5) var<storage, read> sites: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> plans: array<Plan>;
@group(0) @binding(7) var<storage, read_write> tallies: array<u32>;

const HALF_TURN = 3.14159265358979;

var<workgroup> halved: atomic<u32>;

// The nearest particle with which a small one can be merged.
fn mate_of(i: u32, own: Particle) -> u32 {
    let site = sites[i];
    let cells = cells_round(parameters.grid, site.xy, site.w);
    var mate = ALONE;
    var nearest = 3e38;
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            if j == i || distance(sites[j].xy, site.xy) >= site.w || !is_small(particles[j]) {
                continue;
            }
            let other = particles[j];
            let apart = distance(other.place, own.place);
            let area = area_of(own) + area_of(other);
            let fits = own.volume + other.volume <= parameters.largest && area < MERGED * parameters.widest;
            if fits && apart * apart < 2.0 * area && apart < nearest {
                nearest = apart;
                mate = j;
            }
        }
    }
    return mate;
}

// The direction in which a particle has the fewest neighbours: across the largest of sum W e (x) e over unit vectors e to them.
fn emptiest(i: u32) -> f32 {
    let place = sites[i].xy;
    let reach = sites[i].w;
    // Of the tensor its difference along x and y, and twice its shear.
    var tensor = vec2f(0.0);
    let mirrors = mirrors_round(parameters, place);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, parameters);
        if !sees(mirror, parameters, place, reach) {
            continue;
        }
        let cells = cells_round(parameters.grid, behind(mirror, place), reach);
        for (var row = cells.y; row <= cells.w; row++) {
            let line = row * parameters.grid.columns;
            for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
                let there = shown(mirror, sites[j].xy);
                let way = there - place;
                let r = length(way);
                if r >= reach || r == 0.0 || (k > 0u && !has_image(mirror, parameters, there, sites[j].w)) {
                    continue;
                }
                let to = way / r;
                tensor += spline(r, 2.0 / reach) * vec2f(to.x * to.x - to.y * to.y, 2.0 * to.x * to.y);
            }
        }
    }
    // The main axis of a symmetric tensor; the least is at right angles to it.
    let main_axis = select(0.0, 0.5 * atan2(tensor.y, tensor.x), any(tensor != vec2f(0.0)));
    return main_axis + 0.5 * HALF_TURN;
}

fn plan_of(i: u32) -> Plan {
    let own = particles[i];
    if is_small(own) {
        return Plan(mate_of(i, own), 0.0);
    }
    if is_wide(own) {
        let axis = emptiest(i);
        if !is_held(half_of(own, axis, -1.0).place) && !is_held(half_of(own, axis, 1.0).place) {
            return Plan(HALVED, axis);
        }
    }
    return Plan(ALONE, 0.0);
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    if id.x < status.particles {
        let plan = plan_of(id.x);
        plans[id.x] = plan;
        if plan.mate == HALVED {
            atomicAdd(&halved, 1u);
        }
    }
    workgroupBarrier();
    if thread == 0u {
        tallies[OF_GROUPS + group.x] = atomicLoad(&halved);
    }
}
