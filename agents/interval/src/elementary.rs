//! Elementary functions of intervals, rounded outwards: one file a family.

mod roots_and_order;
mod trigonometry;
