// Number of groups with a thread for each of `count` elements.
#import declared

fn groups_for(count: u32) -> u32 {
    return (count + GROUP - 1u) / GROUP;
}
