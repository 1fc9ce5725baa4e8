// What the particles of each solid sum up to in a step, and to what they are brought where the temperature that they are held at changes: a
// group for each solid. The latter is the twin of `hold` in `dew/mod.rs`.
#import dew_particles
#import dew_rows
#import group_reduction

// Heat through the surface, heat it was held against, water, how stiff.
alias Reduced = vec4f;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return vec4f(a.xyz + b.xyz, max(a.w, b.w));
}

fn hold(body: Body, thread: u32) {
    if body.first_row >= body.end_row {
        return;
    }
    let temperature = value_at(body.first_row, body.end_row, add(status.time, status.step));
    for (var i = body.first + thread; i < body.end; i += GROUP) {
        solids[i].temperature = vec2f(temperature, 0.0);
    }
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    var own = vec4f(0.0);
    for (var i = bodies[group.x].first + thread; i < bodies[group.x].end; i += GROUP) {
        own = combine(own, vec4f(solids[i].flow, solids[i].held, solids[i].water, solids[i].stiff));
    }
    hold(bodies[group.x], thread);
    let all = reduce_group(thread, own);
    if thread == 0u {
        bodies[group.x].flow = all.x;
        bodies[group.x].held = add(bodies[group.x].held, all.y);
        bodies[group.x].water = all.z;
        bodies[group.x].stiff = all.w;
    }
}
