// Halves and merges particles as planned. Twin of `Refinement::refine` in `refinement.rs`. Two are merged where each is the other's best:
// then no third one is at them, whatever the threads do.
#import flood_refinement
#import sums_before

@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(3) var<storage, read> plans: array<Plan>;
@group(0) @binding(4) var<storage, read> tallies: array<u32>;

fn halve(i: u32, number: u32) {
    let whole = particles[i];
    let axis = plans[i].axis;
    particles[i] = half_of(whole, axis, -1.0);
    var half = half_of(whole, axis, 1.0);
    half.id = tallies[FIRST_ID] + number;
    particles[tallies[BEFORE] + number] = half;
}

fn merge(i: u32, mate: u32) {
    let both = joined(particles[i], particles[mate]);
    if !is_held(both.place) {
        particles[i] = both;
        particles[mate].volume = 0.0;
        particles[mate].weight = 0.0;
    }
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let i = id.x;
    var mate = ALONE;
    if i < tallies[BEFORE] {
        mate = plans[i].mate;
    }
    let ranks = sums_before(thread, select(0u, 1u, mate == HALVED));
    let number = tallies[OF_GROUPS + group.x] + ranks.x;
    if mate == HALVED {
        if number < tallies[MAY_COME] {
            halve(i, number);
        }
    } else if mate != ALONE && i < mate && plans[mate].mate == i {
        merge(i, mate);
    }
}
