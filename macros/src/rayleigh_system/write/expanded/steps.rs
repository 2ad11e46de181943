//! The step's equation, and the functions of explicit steps.

use super::*;

impl Text<'_> {
    /// The kernel of a rule.
    pub(super) fn kernel(&self, kernel: &derived::Kernel) -> Kernel {
        let derived::Kernel {
            step_kernel,
            momenta,
            diagonals,
            is_linear,
            keeps_matrix,
            explicit,
            friction,
            ..
        } = kernel;
        let line = self.line(step_kernel);
        let (p0, matrix) = line.outputs.split_at(self.derived.n);
        let ([p0], matrix) = (self.parts(p0, [Shape::Vector]), self.matrix_in_form(matrix, *diagonals));
        let result = quote!(StepKernel { p0: #p0, matrix: #matrix });
        let step_kernel = self.framed(step_kernel.of, &line, result);

        let line = self.line(momenta);
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let momenta = self.framed(momenta.of, &line, quote!(Momenta { p0: #p0, p1: #p1 }));

        Kernel {
            step_kernel,
            momenta,
            diagonals: *diagonals,
            is_linear: *is_linear,
            memory: match () {
                () if explicit.is_some() => Memory::Explicit,
                () if *keeps_matrix => Memory::Matrix,
                () => Memory::Velocities,
            },
            explicit: explicit.as_ref().map(|explicit| self.explicit(explicit, *diagonals)),
            friction: *friction,
        }
    }

    /// The functions of `Explicit`.
    fn explicit(&self, explicit: &derived::Explicit, diagonals: Option<usize>) -> TokenStream {
        let (scalar, n) = (&self.system.scalar, self.system.degrees.times(1));
        let of_step = |line: &StraightLine| parameter("h", line.uses("half") || line.uses("h"));

        let line = self.line(&explicit.matrix);
        let matrix = self.matrix_in_form(&line.outputs, diagonals);
        let (h, half, statements) = (of_step(&line), line.half(), &line.statements);
        let step_matrix = quote! {
            #[inline]
            fn step_matrix(&self, #h: #scalar) -> <Self as Fused<Trapezoidal, #n>>::Matrix {
                #half
                #statements
                #matrix
            }
        };

        let line = self.line(&explicit.momenta);
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let (v, h) = (parameter("v", line.uses_velocities), of_step(&line));
        let (half, statements) = (line.half(), &line.statements);
        let velocity_momenta = quote! {
            #[inline]
            fn velocity_momenta(&self, #v: &Vector, #h: #scalar) -> Momenta<#scalar, #n> {
                #half
                #statements
                Momenta { p0: #p0, p1: #p1 }
            }
        };

        let line = self.line_at_present(&explicit.force);
        let [force] = self.parts(&line.outputs, [Shape::Vector]);
        let (q, statements) = (parameter("q", line.uses_coordinates), &line.statements);
        quote! {
            #step_matrix

            #velocity_momenta

            #[inline]
            fn configuration_force(&self, #q: &Vector) -> Vector {
                #statements
                #force
            }
        }
    }
}
