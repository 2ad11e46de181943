//! What the scenes share: the picture style. Each scene is one file of `examples/`.
