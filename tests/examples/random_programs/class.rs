//! The classes of constructs that programs are made of. Each program draws some of them, so that rare
//! combinations occur and one refused construct does not refuse all.

macro_rules! classes {
    ($($variant:ident $name:literal $percent:literal)*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Class {
            $($variant),*
        }

        impl Class {
            /// Each with the percentage of programs that may use it; 0 where it is drawn apart.
            pub const ALL: &[(Self, usize)] = &[$((Self::$variant, $percent)),*];

            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),*
                }
            }
        }
    };
}

classes! {
    SinglePrecision "system in f32" 10
    OtherFloat "`f32` in a system of f64" 12
    Shadowing "shadowing" 50
    LateInitialisation "`let` without a value" 20
    TuplePattern "tuple patterns" 40
    SlicePattern "array patterns" 25
    RestPattern "array patterns with `..`" 20
    AtPattern "`name @ pattern`" 20
    Guard "guards of arms" 20
    OrPattern "or-patterns" 15
    RangePattern "range patterns" 20
    ReferencePattern "reference patterns" 40
    ConstantPattern "constants as patterns" 30
    Match "`match` on integers, bools, tuples" 50
    MatchField "`match` on fields" 25
    IfLet "`if let`" 20
    LetElse "`let … else`" 15
    Matches "`matches!`" 12
    Options "Options" 25
    Enumerations "enums with data" 25
    NestedStructures "structs within structs" 30
    NestedArrays "arrays of arrays" 30
    ArrayMutation "entries assigned" 50
    TupleFields "tuples" 50
    If "`if` on numbers" 75
    KnownIf "`if` on integers and fields" 60
    Return "early return" 20
    For "`for` over ranges" 50
    ForArray "`for` over arrays and iterators" 40
    While "`while`" 30
    Loop "`loop`" 20
    Label "labelled `break` and `continue`" 15
    BreakValue "`break` with a value" 10
    Departure "`break` and `continue`" 25
    Closure "closures" 40
    ChangingClosure "closures that change what they capture" 6
    Chains "iterator chains" 50
    Map "`map`" 50
    Zip "`zip`" 40
    Enumerate "`enumerate`" 30
    Reversed "`rev`" 25
    SkipTake "`skip`, `take`, `step_by`" 30
    Linked "`chain`" 20
    Windows "`windows`, `chunks`" 25
    Filter "`filter`" 20
    Fold "`fold`" 30
    FlatMap "`flat_map`" 15
    FunctionHanded "functions handed on by name" 20
    IteratorLocal "iterators in locals, consumed in parts" 10
    Integers "integers of all widths" 50
    IntegerBounds "integers near the bounds of their types" 25
    Shift "shifts and bits" 25
    IntegerMethods "methods of integers" 35
    WrappingMethods "`wrapping_…`, `saturating_…`" 25
    IntegerCasts "casts between integers" 35
    FloatCasts "casts of constants and fields to integers" 8
    BoolCasts "casts of bools" 15
    SideEffects "side effects in operands, arguments, scrutinees" 30
    IndexEffects "side effects in indices" 25
    ShortCircuit "side effects right of `&&` and `||`" 30
    CompoundEffects "side effects in compound assignments" 20
    BlockExpressions "block expressions" 50
    Helpers "helpers" 50
    Recursion "recursive helpers" 15
    BlockConstants "constants of the block" 30
    ModuleConstants "constants of the module" 30
    Functions "elementary functions" 80
    Cfg "`#[cfg]` inside the block" 1
    Input "inputs" 0
    Time "the time" 0
}
