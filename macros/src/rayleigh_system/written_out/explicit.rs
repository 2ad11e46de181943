//! An explicit step by the trapezoidal rule, in three functions: the matrix, what v̄ adds to the momenta, and
//! the force.

use super::in_lanes::TAKEN;
use super::kernel::Parts;
use super::*;

impl Code<'_> {
    /// The functions of `Explicit`, and the lines of those of `ExplicitInLanes` where they are asked for.
    pub(super) fn explicit(&mut self, parts: &Parts, diagonals: Option<usize>) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let n = self.system.degrees.times(1);
        let half = self.graph.half_step();

        let matrix = self.matrix(|code, i, j| {
            let second = [&parts.lagrangian, &parts.rayleigh].map(|of| code.second(of, (i, true), (j, true)));
            let drag = second[1].map(|drag| code.graph.times(half, drag));
            [second[0], drag].into_iter().flatten().reduce(|a, b| code.graph.plus(a, b))
        });
        let (line, matrix) = self.newton_matrix(&matrix, diagonals)?;
        let (h, statements) = (parameter("h", line.uses("half") || line.uses("h")), &line.statements);
        let let_half = |line: &StraightLine| line.uses("half").then(|| quote!(let half = 0.5 * h;));
        let prelude = let_half(&line);
        let step_matrix = quote! {
            #[inline]
            fn step_matrix(&self, #h: #scalar) -> <Self as Fused<Trapezoidal, #n>>::Matrix {
                #prelude
                #statements
                #matrix
            }
        };

        let (mut p0, mut p1, mut force) = (Vec::new(), Vec::new(), Vec::new());
        for index in 0..self.n {
            let (v, q) = (self.variable(index, true), self.variable(index, false));
            let l_v = parts.lagrangian.gradient.get(&v).copied();
            let r_v = parts.rayleigh.gradient.get(&v).copied().map(|r_v| self.graph.times(half, r_v));
            let drag = r_v.map(|r_v| self.graph.negated(r_v));
            let terms = [parts.lagrangian.gradient.get(&q).copied(), parts.force.get(index).copied()];
            for (sums, terms) in [(&mut p0, [l_v, r_v]), (&mut p1, [l_v, drag]), (&mut force, terms)] {
                let sum = terms.into_iter().flatten().reduce(|a, b| self.graph.plus(a, b));
                sums.push(self.or_zero(sum));
            }
        }
        let is_in_lanes = self.system.lanes.explicit.is_some();
        let momenta = self.shortened(&[p0, p1].concat())?;
        let line = self.members_code(&momenta, &TAKEN, is_in_lanes);
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let (v, h) =
            (parameter("v", line.uses_velocities), parameter("h", line.uses("half") || line.uses("h")));
        let (prelude, statements) = (let_half(&line), &line.statements);
        let velocity_momenta = quote! {
            #[inline]
            fn velocity_momenta(&self, #v: &Vector, #h: #scalar) -> Momenta<#scalar, #n> {
                #prelude
                #statements
                Momenta { p0: #p0, p1: #p1 }
            }
        };

        let force = self.shortened(&force)?;
        if is_in_lanes {
            self.in_lanes.explicit = self.explicit_lines(&momenta, &force);
        }
        let line = self.members_code(&force, &TAKEN, is_in_lanes);
        let [force] = self.parts(&line.outputs, [Shape::Vector]);
        let (q, statements) = (parameter("q", line.uses_coordinates), &line.statements);
        let time = line.uses("t").then(|| quote!(let t = self.t;));
        Ok(quote! {
            #step_matrix

            #velocity_momenta

            #[inline]
            fn configuration_force(&self, #q: &Vector) -> Vector {
                #time
                #statements
                #force
            }
        })
    }
}
