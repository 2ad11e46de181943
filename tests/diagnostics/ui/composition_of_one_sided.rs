use dalembert::{Composition, OneSided};
use dalembert::rules::{DisplacementRule, Node};

#[derive(Clone, Copy)]
struct Rectangle;
impl DisplacementRule for Rectangle {
    const NODES: &'static [Node] = &[Node { position: 0.0, weight: 1.0 }];
}

fn main() {
    let _ = Composition::kahan_li_6(OneSided);
    let _ = Composition::kahan_li_8(Rectangle);
}
