// Sums that do not forget what is small: `Account`. Declares the parameters.
#import flood_card

@group(0) @binding(0) var<uniform> parameters: Parameters;

// A number that compilers cannot tell: some take (a + b) - a for b, and what a sum has too much for 0.
fn opaque(number: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(number) ^ parameters.zero);
}

fn add(account: ptr<function, Account>, value: f32) {
    let more = value - (*account).lacking;
    let sum = opaque((*account).sum + more);
    (*account).lacking = opaque(sum - (*account).sum) - more;
    (*account).sum = sum;
}

fn book_momentum(status: ptr<function, Status>, momentum: f32) {
    var lost = (*status).momentum_lost;
    var gained = (*status).momentum_gained;
    add(&lost, max(-momentum, 0.0));
    add(&gained, max(momentum, 0.0));
    (*status).momentum_lost = lost;
    (*status).momentum_gained = gained;
}
