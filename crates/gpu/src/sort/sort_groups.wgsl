// What the kernels of the sort share.
#import sums_before

struct Sizes {
    particles: u32,
    cells: u32,
}
