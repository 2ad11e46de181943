// How the methods are named and drawn, one over the other. Colours are told apart with any colour vision (Okabe and Ito, 2008);
// where curves lie on each other, each is seen on both sides of the next.

export const methods = {
    rule: { name: "midpoint", colour: "#0072b2", width: 5 },
    rungeKutta: { name: "RK4", colour: "#d55e00", width: 3 },
    reference: { name: "reference", colour: "#000000", width: 1 },
};

// What `rule` may be: how the module calls it, and how the page.
export const rules = {
    midpoint: "midpoint",
    trapezoidal: "trapezoidal",
    gauss: "Gauss",
};
