// What the particles of each solid sum up to in a step: a group for each solid.
#import dew_card

@group(0) @binding(1) var<storage, read> solids: array<Solid>;
@group(0) @binding(2) var<storage, read_write> bodies: array<Body>;

// Heat through the surface, heat it was held against, how stiff.
var<workgroup> sums: array<vec3f, 256>;

fn joined(a: vec3f, b: vec3f) -> vec3f {
    return vec3f(a.xy + b.xy, max(a.z, b.z));
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    var own = vec3f(0.0);
    for (var i = bodies[group.x].first + thread; i < bodies[group.x].end; i += 256u) {
        own = joined(own, vec3f(solids[i].flow, solids[i].held, solids[i].stiff));
    }
    sums[thread] = own;
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
        bodies[group.x].stiff = sums[0].z;
    }
}
