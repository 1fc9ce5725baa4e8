// How splats add up water and foam: in whole numbers, so fine that a millionth of a metre counts, and up to 4096 m.
const PER_UNIT = 1048576.0;
// The greatest number below 2^32 in single precision.
const MOST_ADDED = 4294967040.0;
// The same of the flow, in steps of 1/65536 m/s; and the most of one particle, m/s, of which 256 are held.
const PER_FLOW = 65536.0;
const MOST_FLOW = 127.0;
