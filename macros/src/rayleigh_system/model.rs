//! The model of a system: all that is known of it once it is checked.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};
use syn::{Expr, ExprLit, FnArg, Ident, ImplItem, ImplItemFn, ItemFn, Lit, Pat, Type, Visibility};

use super::parts::{Arguments, Part};
use super::rules::Rules;
use super::syntax::{is_integer, with_self_named};

/// The engine that makes the derivatives, as the attribute asks.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
pub enum Engine {
    /// Written out where every body can be lowered, num-dual otherwise.
    #[default]
    Auto,
    /// Written out by the macro.
    Expanded,
    /// Dual numbers, when the program runs.
    NumDual,
}

/// The annotated item as parsed.
pub enum Source {
    Block(Box<Block>),
    Function(Box<Function>),
}

/// `impl Ring { … }`.
pub struct Block {
    pub item: syn::ItemImpl,
    /// The name of the system, `Ring`.
    pub name: Ident,
}

/// `fn oscillator(q: [f64; 1], v: [f64; 1], m: f64) -> (f64, f64) { … }`.
pub struct Function {
    pub item: ItemFn,
    /// The name of the struct generated, `Oscillator`.
    pub name: Ident,
    pub role: Role,
}

/// The role of a free function.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// L and R of (q, v, parameters…).
    System,
    /// A field on the configuration space, of (q, parameters…).
    Field,
}

impl Role {
    /// How many parameters come before those that become fields of the struct.
    pub fn arguments(self) -> usize {
        match self {
            Self::System => 2,
            Self::Field => 1,
        }
    }
}

/// The number of degrees of freedom, as written in the array type.
#[derive(Clone)]
pub struct Degrees {
    pub length: Expr,
    /// `Self` in the length stands for this type.
    pub system: Ident,
}

impl Degrees {
    /// The literal, if the length is one.
    pub fn literal(&self) -> Option<usize> {
        match &self.length {
            Expr::Lit(ExprLit { lit: Lit::Int(literal), .. }) => literal.base10_parse().ok(),
            _ => None,
        }
    }

    /// `factor` × N as a const generic argument.
    pub fn times(&self, factor: usize) -> TokenStream {
        if let Some(product) = self.literal().and_then(|n| n.checked_mul(factor)) {
            return Literal::usize_unsuffixed(product).into_token_stream();
        }
        let length = with_self_named(&self.length, &self.system);
        match (factor, &self.length) {
            (1, Expr::Path(_) | Expr::Block(_) | Expr::Lit(_)) => quote!({ #length }),
            // At the start of a block, `if a { b } else { c } + d` would end at its brace.
            (1, _) => quote!({ (#length) }),
            _ => {
                let factor = Literal::usize_unsuffixed(factor);
                quote!({ #factor * (#length) })
            }
        }
    }
}

/// A checked system.
#[derive(Clone)]
pub struct System<'a> {
    pub source: &'a Source,
    /// The name of the type.
    pub name: Ident,
    pub degrees: Degrees,
    /// `f64` or `f32`.
    pub scalar: Ident,
    pub rules: Rules,
    /// The engine that the attribute asks for.
    pub engine: Engine,
    /// The functions that it has of those that the attribute knows.
    pub bodies: Vec<Body>,
    /// The arguments of each part, in the order of `Part::ALL`, where there is one.
    pub takes: [Option<Arguments>; Part::ALL.len()],
    /// The number of entries of the input u, if there is one.
    pub input: Option<Degrees>,
    /// The numbers of constraints and of velocity constraints, where there are any.
    pub constraints: [Option<Degrees>; 2],
    /// The numbers of event functions and of outputs, where there are any.
    pub values: [Option<Degrees>; Part::VALUES.len()],
    /// Fields that the step is differentiated by, as listed: `m`, `c[0]`.
    pub parameters: Vec<Expr>,
    /// Whether the step is differentiated twice.
    pub second: bool,
    /// Which steps of several members at once are asked for.
    pub lanes: Lanes,
    /// Whether a product and the sum that it stands in are rounded once, by its word.
    pub fused: Option<Ident>,
}

/// The steps of several members at once that are asked for, each by its word.
#[derive(Clone, Default)]
pub struct Lanes {
    /// Steps of the trapezoidal rule where they are explicit, of its compositions and of splittings.
    pub explicit: Option<Ident>,
    /// Steps of the midpoint rule.
    pub midpoint: Option<Ident>,
    /// Steps of the Gauss rules.
    pub gauss: Option<Ident>,
}

impl Lanes {
    /// The words, as they stand.
    pub fn words(&self) -> impl Iterator<Item = &Ident> {
        self.explicit.iter().chain(&self.midpoint).chain(&self.gauss)
    }
}

/// The type that one of the runtime's traits is implemented for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Home {
    /// The user's type.
    System,
    /// The generated view of it with the input held and the time set.
    View,
}

impl System<'_> {
    /// The arguments of a part, if there is one.
    pub fn takes(&self, part: Part) -> Option<Arguments> {
        self.takes[part as usize]
    }

    pub fn has(&self, part: Part) -> bool {
        self.takes(part).is_some()
    }

    /// Whether a part that there is takes the time.
    pub fn takes_time(&self, part: Part) -> bool {
        self.takes(part).is_some_and(|takes| takes.t)
    }

    /// Whether any part takes the time.
    pub fn is_timed(&self) -> bool {
        Part::ALL.into_iter().any(|part| self.takes_time(part))
    }

    /// Whether u or t occurs: then a step is that of a view.
    pub fn has_view(&self) -> bool {
        self.input.is_some() || self.is_timed()
    }

    /// M as a const generic argument, 0 where there is no input.
    pub fn inputs(&self) -> TokenStream {
        self.input.as_ref().map_or_else(|| quote!(0), |input| input.times(1))
    }

    /// Whether constraints hold it.
    pub fn is_constrained(&self) -> bool {
        self.constraints.iter().any(Option::is_some)
    }

    /// The number of all constraints as a const generic argument, 0 where there are none.
    pub fn constraint_count(&self) -> TokenStream {
        match &self.constraints {
            [None, None] => quote!(0),
            [Some(count), None] | [None, Some(count)] => count.times(1),
            [Some(first), Some(second)] => {
                let (first, second) = (first.times(1), second.times(1));
                quote!({ #first + #second })
            }
        }
    }

    /// The number of values of a part of [`Part::VALUES`] as a const generic argument, if there is one.
    pub fn value_count(&self, part: Part) -> Option<TokenStream> {
        let of = Part::VALUES.into_iter().zip(&self.values).find(|(of, _)| *of == part);
        of.and_then(|(_, count)| count.as_ref()).map(|count| count.times(1))
    }

    /// P as a const generic argument.
    pub fn parameter_count(&self) -> Literal {
        Literal::usize_unsuffixed(self.parameters.len())
    }

    /// The terms of the equations of motion that the system has, of L, R and f.
    pub fn terms(&self) -> impl Iterator<Item = Part> {
        Part::ALL.into_iter().filter(|part| part.entry().is_term && self.has(*part))
    }

    /// Where L_d, f_d and the step stand.
    pub fn home(&self) -> Home {
        if self.has_view() { Home::View } else { Home::System }
    }

    /// Where a part stands: on the system wherever neither u nor t is needed. What stands beside L is of the
    /// view where L is.
    pub fn home_of(&self, part: Part) -> Home {
        let is_timed = |part| self.takes_time(part);
        let needs_view = is_timed(Part::Lagrangian)
            || match part {
                Part::Lagrangian | Part::Rayleigh | Part::Events => is_timed(part),
                Part::Outputs => is_timed(part) || self.takes(part).is_some_and(|takes| takes.u),
                Part::Force | Part::TimeScale => self.has_view(),
                Part::Constraints | Part::VelocityConstraints => Part::CONSTRAINTS.into_iter().any(is_timed),
            };
        if needs_view { Home::View } else { Home::System }
    }
}

/// A function to differentiate, as the user wrote it.
#[derive(Clone)]
pub struct Body {
    pub function: ImplItemFn,
    /// Otherwise its types have been complained of already, and only the statements are still looked at.
    pub has_right_signature: bool,
}

impl Source {
    pub fn name(&self) -> &Ident {
        match self {
            Self::Block(block) => &block.name,
            Self::Function(function) => &function.name,
        }
    }

    /// Functions of the annotated block.
    pub fn functions(&self) -> impl Iterator<Item = &ImplItemFn> {
        let items: &[ImplItem] = match self {
            Self::Block(block) => &block.item.items,
            Self::Function(_) => &[],
        };
        items.iter().filter_map(|item| match item {
            ImplItem::Fn(function) => Some(function),
            _ => None,
        })
    }

    /// Constants of the annotated block whose type is no floating-point number.
    pub fn integer_constants(&self) -> impl Iterator<Item = &Ident> {
        let items: &[ImplItem] = match self {
            Self::Block(block) => &block.item.items,
            Self::Function(_) => &[],
        };
        items.iter().filter_map(|item| match item {
            ImplItem::Const(constant) if is_integer(&constant.ty) => Some(&constant.ident),
            _ => None,
        })
    }
}

impl Function {
    pub fn visibility(&self) -> &Visibility {
        &self.item.vis
    }

    /// Names and types of the parameters that become fields of the struct.
    pub fn fields(&self) -> impl Iterator<Item = (&Ident, &Type)> {
        self.item.sig.inputs.iter().skip(self.role.arguments()).filter_map(|parameter| match parameter {
            FnArg::Typed(parameter) => match &*parameter.pat {
                Pat::Ident(pattern) => Some((&pattern.ident, &*parameter.ty)),
                _ => None,
            },
            FnArg::Receiver(_) => None,
        })
    }
}

/// How the runtime beside the macro is built: the runtime exports the macro that fits.
#[derive(Clone, Copy)]
pub struct Runtime {
    /// With the standard library, and num-dual.
    pub has_std: bool,
    /// With elementary functions of its own, not the standard library's.
    pub is_portable: bool,
}

impl Runtime {
    /// With the standard library and its functions.
    pub const STD: Self = Self { has_std: true, is_portable: false };
    /// With the standard library, but not its functions.
    pub const PORTABLE: Self = Self { has_std: true, is_portable: true };
    /// On `core` alone.
    pub const CORE: Self = Self { has_std: false, is_portable: true };
}
