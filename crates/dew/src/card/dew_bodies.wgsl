// What the particles of each solid sum up to in a step, and to what they are brought where the temperature that they are held at changes: a
// group for each solid. The latter is the twin of `hold` in `dew.rs`.
#import dew_card
#import dew_rows

// Heat through the surface, heat it was held against, water, how stiff.
var<workgroup> sums: array<vec4f, 256>;

fn joined(a: vec4f, b: vec4f) -> vec4f {
    return vec4f(a.xyz + b.xyz, max(a.w, b.w));
}

fn hold(body: Body, thread: u32) {
    if body.first_row >= body.end_row {
        return;
    }
    let temperature = value_at(body.first_row, body.end_row, add(status.time, status.step));
    for (var i = body.first + thread; i < body.end; i += 256u) {
        solids[i].temperature = Account(temperature, 0.0);
    }
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    var own = vec4f(0.0);
    for (var i = bodies[group.x].first + thread; i < bodies[group.x].end; i += 256u) {
        own = joined(own, vec4f(solids[i].flow, solids[i].held, solids[i].water, solids[i].stiff));
    }
    sums[thread] = own;
    hold(bodies[group.x], thread);
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] = joined(sums[thread], sums[thread + half]);
        }
        workgroupBarrier();
    }
    if thread == 0u {
        bodies[group.x].flow = sums[0].x;
        bodies[group.x].held = add(bodies[group.x].held, sums[0].y);
        bodies[group.x].water = sums[0].z;
        bodies[group.x].stiff = sums[0].w;
    }
}
