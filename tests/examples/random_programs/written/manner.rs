//! Ways of writing that people have, and how often a program has each.

macro_rules! manners {
    ($($name:ident: $percent:literal, $said:literal;)*) => {
        /// A way of writing.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Manner {
            $($name,)*
        }

        impl Manner {
            /// All, with the percentage of programs that may have it.
            pub const ALL: &[(Self, usize)] = &[$((Self::$name, $percent),)*];

            /// As the page says it.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$name => $said,)*
                }
            }
        }
    };
}

manners! {
    Single: 12, "system in f32";
    OneLetter: 50, "constants of one letter";
    SmallConstants: 15, "constants and statics in small letters";
    BlockConstants: 35, "constants of the block";
    PathConstants: 20, "constants of a module within, and of a type";
    ConstGenerics: 8, "constants of a generic type";
    StandardConstants: 20, "`std::f64::consts`";
    Nested: 35, "structs within the system";
    Arrays: 25, "arrays as fields";
    Tuples: 15, "tuples as fields";
    Newtypes: 20, "newtypes, read by `.0`";
    OwnOperators: 15, "newtypes with `Deref` and operators of their own";
    Boxes: 15, "`Box` and references as fields";
    OtherPrecision: 15, "numbers of the other precision";
    Integers: 20, "integers as fields, and casts";
    Helpers: 40, "helpers of the block";
    Closures: 30, "closures";
    Recursion: 10, "helpers that call themselves";
    FreeFunctions: 3, "functions outside the block";
    StructMethods: 4, "methods of structs within the system";
    OwnMethods: 4, "methods of a trait of one's own on numbers";
    SliceNames: 10, "a trait of one's own with methods named like slices'";
    Tables: 40, "tables with straight pieces between their entries";
    LetterTables: 15, "a table of one letter beside a local of the small one";
    Laws: 30, "laws as enums";
    Options: 15, "`Option` as a field";
    StructArrays: 25, "arrays of structs";
    Contacts: 25, "penalties of contact";
    EarlyReturns: 15, "early return";
    Decisions: 20, "integers and bools of the system that decide";
    Turns: 12, "`while`, `loop` and labels";
    FunctionPaths: 20, "functions by path, as `f64::sin`";
    Matrices: 15, "matrices as arrays of arrays";
    SeveralHelpers: 18, "helpers of arrays and tuples";
    Literals: 3, "structs made in the body";
    Imports: 15, "imports, and the number of coordinates as a constant";
    Shadowing: 20, "shadowing";
    MacroAround: 22, "`macro_rules` around the block";
    Fragments: 18, "expressions handed on by `macro_rules`";
    TwoHygienes: 15, "locals of a macro and of its caller with one name";
    GeneratedNames: 15, "types named like those of generated code";
    Inputs: 15, "an input";
    Times: 10, "the time";
}
