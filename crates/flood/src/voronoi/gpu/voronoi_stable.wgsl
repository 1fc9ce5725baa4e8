// The longest stable time step of a cell over the Courant number, s.
#import declared

fn stable_step(cell: u32) -> f32 {
    let now = water[cell];
    if now.depth <= 0.0 {
        return FAR;
    }
    return ground[cell].width / (length(now.velocity) + sqrt(parameters.gravity * now.depth));
}
