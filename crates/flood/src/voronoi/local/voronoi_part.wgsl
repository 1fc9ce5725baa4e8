// Begins a part of a step, or none where the step has fewer: see `begin` in `local/mod.rs`. One thread.
#import declared
#import voronoi_groups

@compute @workgroup_size(1)
fn main() {
    // The finish of a step leaves the last part before the first.
    let part = status.part + 1u;
    status.part = part;
    status.now = min(countTrailingZeros(part), countTrailingZeros(status.parts));
    let goes_on = status.halted == GOING && part < status.parts;
    groups[3u * PART_CELL_SLOT] = select(0u, groups_for(parameters.cells), goes_on);
    groups[3u * PART_FACE_SLOT] = select(0u, groups_for(parameters.faces), goes_on);
    groups[3u * PART_BORDER_SLOT] = select(0u, groups_for(parameters.borders), goes_on);
}
