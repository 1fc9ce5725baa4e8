// Groups of threads with a thread for each of so many.
#import declared

fn groups_for(count: u32) -> u32 {
    return (count + GROUP - 1u) / GROUP;
}
