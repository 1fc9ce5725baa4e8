// What the threads of a group sum up over their particles, after the forces.

// Inner parts of what a group sums up.
struct Sums {
    booked: f32,
    sum_of_h: f32,
    from_outside: vec2f,
    longest: f32,
    low: vec2f,
    high: vec2f,
}

const FAR = 3.0e38;

var<workgroup> sums: array<Sums, 256>;

fn joined(a: Sums, b: Sums) -> Sums {
    return Sums(
        a.booked + b.booked,
        a.sum_of_h + b.sum_of_h,
        a.from_outside + b.from_outside,
        min(a.longest, b.longest),
        min(a.low, b.low),
        max(a.high, b.high),
    );
}

const NOTHING = Sums(0.0, 0.0, vec2f(0.0), FAR, vec2f(FAR), vec2f(-FAR));

// The sum over the group; each thread has put its own in `sums`.
fn summed(thread: u32) -> Sums {
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] = joined(sums[thread], sums[thread + half]);
        }
        workgroupBarrier();
    }
    return sums[0];
}
