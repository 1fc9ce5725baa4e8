// Tables over time or over a level: linear between their rows, constant before the first and after the last.
#import declared

fn number(word: u32) -> f32 {
    return bitcast<f32>(tables[word]);
}

// The value of a table in the step, by the number of the word.
fn in_step(table: u32, word: u32) -> f32 {
    return number(TABLE * table + word);
}

// Distance from an abscissa to that of a row.
fn after(row: u32, abscissa: vec2f) -> f32 {
    return (number(row) - abscissa.x) + (number(row + 1u) - abscissa.y);
}

fn value_of(row: u32) -> f32 {
    return number(row + 2u);
}

// The number of rows of a table up to an abscissa, by bisection.
fn rows_up_to(table: u32, abscissa: vec2f) -> u32 {
    let first = tables[TABLE * table];
    var low = 0u;
    var high = tables[TABLE * table + 1u];
    while low < high {
        let middle = (low + high) / 2u;
        if after(first + ROW * middle, abscissa) <= 0.0 {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// The value at an abscissa; at a jump the one after it.
fn value_at(table: u32, abscissa: vec2f) -> f32 {
    let first = tables[TABLE * table];
    let count = tables[TABLE * table + 1u];
    let passed = rows_up_to(table, abscissa);
    if passed == 0u || passed == count {
        return value_of(first + ROW * (max(passed, 1u) - 1u));
    }
    let right = first + ROW * passed;
    let left = right - ROW;
    let part = -after(left, abscissa) / (after(right, abscissa) - after(left, abscissa));
    return value_of(left) + part * (value_of(right) - value_of(left));
}

// The integral from an abscissa on.
fn integral(table: u32, abscissa: vec2f, length: f32) -> f32 {
    let first = tables[TABLE * table];
    let count = tables[TABLE * table + 1u];
    var sum = 0.0;
    var start = 0.0;
    for (var row = rows_up_to(table, abscissa); row <= count && start < length; row++) {
        let left = first + ROW * (max(row, 1u) - 1u);
        let right = first + ROW * min(row, count - 1u);
        let end = select(min(after(right, abscissa), length), length, row == count);
        var mean = value_of(left);
        let span = after(right, abscissa) - after(left, abscissa);
        if span > 0.0 {
            mean += (value_of(right) - mean) * (0.5 * (start + end) - after(left, abscissa)) / span;
        }
        sum += mean * max(end - start, 0.0);
        start = end;
    }
    return sum;
}
