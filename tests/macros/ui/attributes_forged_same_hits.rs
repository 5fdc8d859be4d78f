// C020, H033: hits of two kinds are not declared one

use optix_device_rs::prelude::*;

#[derive(Clone, Copy, Attributes)]
pub struct BoxHit {
    pub side: u32,
}

#[derive(Clone, Copy, Attributes)]
pub struct TableHit {
    pub table: Slice<u32>,
}

impl optix_device_rs::check::SameHits<TableHit> for BoxHit {}

fn main() {}
