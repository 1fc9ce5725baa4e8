// Makes room for the halves of particles that are to be halved, in the order of the particles. One group.
#import flood_refinement
#import sums_before

@group(0) @binding(2) var<storage, read_write> status: Status;
@group(0) @binding(3) var<storage, read_write> tallies: array<u32>;
// The numbers of groups: of the kernels to come; of those that refine; and of those that rain is shared out by, where it rains.
@group(0) @binding(4) var<storage, read_write> groups: array<u32>;
// As many as there is room for particles.
@group(0) @binding(5) var<storage, read> plans: array<Plan>;

const SHARED = 4u;
const REFINED = 8u;

var<workgroup> of_particles: u32;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        of_particles = groups[3u * REFINED];
    }
    let count = workgroupUniformLoad(&of_particles);
    if count == 0u {
        return;
    }
    var come = 0u;
    for (var first = 0u; first < count; first += 256u) {
        let group = first + thread;
        var own = 0u;
        if group < count {
            own = tallies[OF_GROUPS + group];
        }
        let ranks = sums_before(thread, own);
        if group < count {
            tallies[OF_GROUPS + group] = come + ranks.x;
        }
        come += ranks.y;
    }
    if thread == 0u {
        let before = status.particles;
        // Where there is no room particles stay whole.
        let may_come = min(come, arrayLength(&plans) - before);
        tallies[BEFORE] = before;
        tallies[FIRST_ID] = status.next_id;
        tallies[MAY_COME] = may_come;
        status.particles = before + may_come;
        status.next_id += may_come;
        groups[0] = (before + may_come + 255u) / 256u;
        if groups[3u * SHARED] > 0u {
            groups[3u * SHARED] = groups[0];
        }
    }
}
