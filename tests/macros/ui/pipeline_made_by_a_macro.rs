// T03, D009: a pipeline out of a macro is checked like any other

mod common;
use common::*;

macro_rules! renderer {
    ($name:ident: $record:ty => $shade:path) => {
        pipeline! {
            pub struct $name {
                params: $crate::common::Frame,
                raygen: [camera],
                rays: { Radiance { miss: sky } },
                hitgroups: { $record on Triangles => { Radiance { closesthit: $shade } } },
            }
        }
    };
}
renderer!(PathTracer: Ball => lambert);

fn main() {}
