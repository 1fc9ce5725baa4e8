// What `voronoi_finish.wgsl` does for the next step where cells may take steps of their own: they are planned after each step, and once after an upload that left
// it open; where that was done before, tables are evaluated.
#import declared
#import voronoi_groups
#import voronoi_look_up

fn prepare_next(was: u32, goes_on: bool) {
    let plans = was == GOING || (was == BATCH_START && status.parts == 0u);
    if was == GOING {
        status.shortest = status.step;
    }
    status.part = NONE;
    groups[3u * PLAN_CELL_SLOT] = select(0u, groups_for(parameters.cells), plans);
    groups[3u * PLAN_FACE_SLOT] = select(0u, groups_for(parameters.faces), plans);
    groups[3u * PLAN_SLOT] = select(0u, 1u, plans);
    if !plans && goes_on {
        look_up_all();
    }
}
