// The tensor by which the Laplacian of diffusion is normalised. Twin of `normalisation/mod.rs`.
#import dew_particles
#import smoothing_kernel

// A symmetric matrix: xx, yy, zz; xy, xz, yz.
struct Symmetric {
    diagonal: vec3f,
    others: vec3f,
}

// Sums of the Laplacian's weight times q q q q/|q|^2 over neighbours: x4, y4, z4; x2y2, x2z2, y2z2; and xy, xz, yz times x2, y2 and z2.
struct Moments {
    fourth: vec3f,
    mixed: vec3f,
    of_x: vec3f,
    of_y: vec3f,
    of_z: vec3f,
}

// Adds a neighbour at an offset, over h.
fn add_moments(moments: ptr<function, Moments>, offset: vec3f, volume: f32) {
    let q_squared = dot(offset, offset);
    if q_squared < 1e-18 {
        return;
    }
    let weight = volume * laplacian_shape(sqrt(q_squared)) / q_squared;
    let squares = offset * offset;
    let across = weight * offset.xxy * offset.yzz;
    (*moments).fourth += weight * squares * squares;
    (*moments).mixed += weight * squares.xxy * squares.yzz;
    (*moments).of_x += squares.x * across;
    (*moments).of_y += squares.y * across;
    (*moments).of_z += squares.z * across;
}

// Adds what a row of cells sums up to: sums of sums are rounded less than one long sum.
fn join(moments: ptr<function, Moments>, of_row: Moments) {
    (*moments).fourth += of_row.fourth;
    (*moments).mixed += of_row.mixed;
    (*moments).of_x += of_row.of_x;
    (*moments).of_y += of_row.of_y;
    (*moments).of_z += of_row.of_z;
}

fn inverse(m: Symmetric) -> Symmetric {
    let a = m.diagonal;
    let b = m.others;
    let diagonal = a.yxx * a.zzy - b.zyx * b.zyx;
    let others = vec3f(b.y * b.z - b.x * a.z, b.x * b.z - b.y * a.y, b.x * b.y - a.x * b.z);
    let scale = 1.0 / (a.x * diagonal.x + b.x * others.x + b.y * others.y);
    return Symmetric(scale * diagonal, scale * others);
}

fn times(m: Symmetric, v: vec3f) -> vec3f {
    let o = m.others;
    return m.diagonal * v + vec3f(o.x * v.y + o.y * v.z, o.x * v.x + o.z * v.z, o.y * v.x + o.z * v.y);
}

// What the six equations give for a tensor of doubled components.
fn applied(m: Moments, tensor: Symmetric) -> Symmetric {
    let d = tensor.diagonal;
    let o = tensor.others;
    let mixed = Symmetric(m.mixed, vec3f(m.of_x.z, m.of_y.y, m.of_z.x));
    let all = Symmetric(m.fourth, m.mixed);
    return Symmetric(
        times(all, d) + vec3f(dot(m.of_x, o), dot(m.of_y, o), dot(m.of_z, o)),
        d.x * m.of_x + d.y * m.of_y + d.z * m.of_z + times(mixed, o),
    );
}

// Components xx, yy, zz and, doubled, xy, xz, yz of the tensor that solves the six equations of a right side, from a scalar in its stead. Single precision
// requires it twice: what the first solution leaves of the right side is solved for again.
fn solved(m: Moments, right: f32, scalar: f32) -> Symmetric {
    let inner = inverse(Symmetric(m.mixed, vec3f(m.of_x.z, m.of_y.y, m.of_z.x)));
    let x = times(inner, m.of_x);
    let y = times(inner, m.of_y);
    let z = times(inner, m.of_z);
    let diagonal = m.fourth - vec3f(dot(x, m.of_x), dot(y, m.of_y), dot(z, m.of_z));
    let others = m.mixed - vec3f(dot(x, m.of_y), dot(x, m.of_z), dot(y, m.of_z));
    let outer = inverse(Symmetric(diagonal, others));
    var tensor = Symmetric(vec3f(scalar), vec3f(0.0));
    for (var turn = 0u; turn < 2u; turn++) {
        let found = applied(m, tensor);
        let left = right - found.diagonal;
        let more = times(outer, left + vec3f(dot(x, found.others), dot(y, found.others), dot(z, found.others)));
        tensor.diagonal += more;
        tensor.others -= times(inner, found.others) + more.x * x + more.y * y + more.z * z;
    }
    return tensor;
}

// Whether a tensor of doubled components is positive definite. Not where a number is none.
fn is_positive(tensor: Symmetric) -> bool {
    let a = tensor.diagonal;
    let b = 0.5 * tensor.others;
    let minor = a.x * a.y - b.x * b.x;
    let determinant = a.z * minor - a.x * b.z * b.z - a.y * b.y * b.y + 2.0 * b.x * b.y * b.z;
    return a.x > 0.0 && minor > 0.0 && determinant > 0.0;
}

// The tensor where no weight by it is negative or too large, else a scalar.
fn normalised(moments: Moments) -> Symmetric {
    let mean = parameters.of_moments * dot(moments.fourth + 2.0 * moments.mixed, vec3f(1.0)) / 3.0;
    let scalar = 1.0 / max(mean, 1.0 / MAX_EIGENVALUE);
    let tensor = solved(moments, 1.0 / parameters.of_moments, scalar);
    let below = Symmetric(MAX_EIGENVALUE - tensor.diagonal, -tensor.others);
    if is_positive(tensor) && is_positive(below) {
        return tensor;
    }
    return Symmetric(vec3f(scalar), vec3f(0.0));
}
