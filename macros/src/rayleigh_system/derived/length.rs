//! Outputs in as few operations as they take, and the refusal of those that take too many.

use super::*;

impl Deriving<'_> {
    /// The function of `home` with these outputs, unless they are too long to be written.
    pub(super) fn made(&mut self, of: Of, home: Home, outputs: &[Node]) -> Made<Routine> {
        Ok(Routine { of, home, kind: Kind::Numbers, outputs: self.shortened(outputs)? })
    }

    /// Rewrites `outputs` in few operations, unless they are too long to be written.
    pub(super) fn shortened(&mut self, outputs: &[Node]) -> Made<Vec<Node>> {
        let shortened = self.rounded(outputs)?;
        match self.graph.operations(shortened.iter().copied()) {
            operations if operations > MOST_OPERATIONS => Err(self.too_long(Length::Function(operations))),
            _ => Ok(shortened),
        }
    }

    /// Rewrites `outputs` in fewer operations, rounded as the attribute says.
    pub(super) fn rounded(&mut self, outputs: &[Node]) -> Made<Vec<Node>> {
        self.complete()?;
        let factored = self.graph.factored(outputs, self.written);
        let rounded =
            if self.system.fused.is_some() { self.graph.fused(&factored, self.written) } else { factored };
        self.complete()?;
        Ok(rounded)
    }

    /// Refuses a graph that had no room for all expressions: those in it are not the system's then.
    pub(super) fn complete(&self) -> Made<()> {
        if self.graph.is_full() { Err(self.too_long(Length::Unknown)) } else { Ok(()) }
    }

    /// The refusal of what is too long, at the loop that writes most of it.
    fn too_long(&self, length: Length) -> Refusal {
        match &self.heaviest {
            Some(heaviest) => heaviest.refusal(length),
            None => length.of(self.system.source.name()),
        }
    }
}
