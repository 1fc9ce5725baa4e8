// What `voronoi_finish.wgsl` does for the next step where all cells take the same.
#import declared
#import voronoi_look_up

fn prepare_next(was: u32, goes_on: bool) {
    if goes_on {
        look_up_all();
    }
}
