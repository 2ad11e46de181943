// Written by generator.rs: `UPDATE_SYSTEMS=1 cargo test -p dalembert-tests --test random_engines`.

/// The systems, with the engine named.
macro_rules! systems {
    ($engine:ident) => {
        use dalembert::rayleigh_system;

        pub struct System0 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System0 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * self.c[1].sin()).exp2());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let mut t0 = v[0].hypot(1.0 + q[0] * q[0]);
                        if t0 > self.c[3] && q[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += (v[0] / (2.0 + q[0] * q[0]));
                        }
                        let t1: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[4] * a * b)
                            .sum();
                        (1.5 + v[0] * v[0]).recip() + self.c[5] * (0.7 * t0.sin()).cosh() + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let t0 = if (0.6 * self.c[1].sin()).asin() < self.c[0] {
                    (v[0] - self.c[2])
                } else {
                    self.c[0] * (0.7 * self.c[3].sin()).exp2()
                };
                let t1 = self.c[4] * v.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(v[0]);
                t0.asinh() + self.c[5] * q[0].max(t1) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System1 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System1 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] * q[1]));
                let m1 = 1.0 + self.c[1] + Self::square((q[0] + q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let mut t0 = ({
                            let (s, c) = q[1].sin_cos();
                            s * v[0] + c
                        });
                        if t0 > self.c[2] && q[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += (v[0] + v[1]);
                        }
                        let t1 = self.hill((-self.c[4]), (-q[0]));
                        (0.7 * v[0].sin()).exp() + self.c[5] * (v[1] - t1) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let scale = |x: f64| x * self.c[0] + q[0].cos();
                let t0 = scale(q[0]) * 0.5;
                let t1 = self.c[1] * q.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(q[1]);
                (1.7 + q[1] * q[1]).acosh() + self.c[2] * (0.7 * t0.sin()).exp2() + t1
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [
                    ((v[0] + self.c[3]) * (1.5 + self.c[4] * self.c[4]).ln()),
                    (v[0].abs() + (0.6 * v[0].sin()).acos()),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System2 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System2 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(q[0].cos());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let mut t0 = self.c[2];
                        for (i, &x) in q.iter().enumerate() {
                            if i % 2 == 0 {
                                t0 += x * (q[0] + 3.0_f64);
                            } else {
                                t0 -= 0.5 * x;
                            }
                        }
                        let t1 = self.c[3] * v.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(v[0]);
                        (0.7 * t1.sin()).exp2()
                            + self.c[4]
                                * ({
                                    let (s, c) = v[0].sin_cos();
                                    s * 2.0_f64 + c
                                }) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..1 {
                    t0 += self.c[5] * (self.c[0] + v[0]) * v[i] / (i as f64 + 1.0);
                }
                let mut t1 = (0.1_f64 + t0);
                if t1 > self.c[1] && v[0] < 0.6 {
                    t1 *= 0.5;
                    t1 += (3.0_f64 * v[0]);
                }
                (0.6 * t1.sin()).atanh()
                    + self.c[2]
                        * ({
                            let (s, c) = 2.0_f64.sin_cos();
                            s * t1 + c
                        }) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System3 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System3 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] / (2.0 + q[1] * q[1])));
                let m1 = 1.0 + self.c[1] + Self::square((self.c[2] + 1.25_f64));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = (0.4 * (-1.25_f64).cos()).ln_1p();
                        let t1 = (2.5 + (self.c[5] + v[1]).sin()).cbrt();
                        (0.7 * q[0].sin()).exp_m1() + self.c[1] * (1.5 + t1 * t1).ln() + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let t0: f64 = q.iter().zip(v.iter()).map(|(a, b)| self.c[2] * a * b).sum();
                (1.5 + q[0] * q[0]).sqrt() + self.c[4] * self.c[3].atan() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System4 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System4 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((self.c[1] - q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let scale = |x: f64| x * self.c[2] + (0.7 * v[0].sin()).tan();
                        let t0 = scale(v[0]) * 0.5;
                        let mut t1 = self.c[3];
                        for (i, &x) in q.iter().enumerate() {
                            if i % 2 == 0 {
                                t1 += x * x.tanh();
                            } else {
                                t1 -= 0.5 * x;
                            }
                        }
                        (1.5 + t0 * t0).ln() + self.c[5] * (1.7 + self.c[4] * self.c[4]).acosh()
                            + t1
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System5 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System5 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((self.c[1] / (2.0 + q[1] * q[1])));
                let m1 = 1.0 + self.c[2] + Self::square((q[2] - 3.0_f64));
                let m2 = 1.0 + self.c[3] + Self::square(q[0].asinh());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let t0 = self.c[4] * v.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(v[2]);
                        let t1: f64 = v
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[5] * a * b)
                            .sum();
                        (1.5 + q[2] * q[2]).log2() + self.c[0] * (t1 + q[2]) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let t0 = self.hill((-q[2]), (self.c[2] + q[0]));
                let scale = |x: f64| x * self.c[3] + (v[0] + v[1]);
                let t1 = scale(v[0]) * 0.5;
                (t1 * t1.abs()) + self.c[4] * (-q[2]) + t1
            }
            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                [
                    (1.5 + (2.5 + q[0].sin()).cbrt() * (2.5 + q[0].sin()).cbrt()).log2(),
                    ((q[0] + q[0])
                        / (2.0 + (0.7 * v[1].sin()).sinh() * (0.7 * v[1].sin()).sinh())),
                    (0.4 * q[1].cos()).ln_1p().tanh(),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System6 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System6 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] / (2.0 + 0.1_f64 * 0.1_f64)));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = ((1.5_f64 - v[0])
                            / (2.0 + (0.7 * q[0].sin()).exp2() * (0.7 * q[0].sin()).exp2()));
                        let t1 = (q[0].abs() + (v[0] * q[0]));
                        (1.5 + t1 * t1).log10() + self.c[3] * (20.0 * 1.25_f64.to_radians()) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = (v[0] * v[0]);
                if t0 > self.c[4] && q[0] < 0.6 {
                    t0 *= 0.5;
                    t0 += (1.5 + q[0] * q[0]).recip();
                }
                let mut t1 = self.c[5];
                for (i, &x) in v.iter().enumerate() {
                    if i % 2 == 0 {
                        t1 += x * (t0 * 3.0_f64);
                    } else {
                        t1 -= 0.5 * x;
                    }
                }
                q[0].signum() + self.c[1] * t0.mul_add(t1, self.c[0]) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System7 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System7 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] + q[1]));
                let m1 = 1.0 + self.c[1] + Self::square((0.6 * q[0].sin()).acos());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = if (0.6 * self.c[3].sin()).atanh() < self.c[2] {
                            q[1].atan2(2.0 + q[1] * q[1])
                        } else {
                            self.c[2] * (v[1] * q[0])
                        };
                        (0.4 * v[0].cos()).ln_1p() + self.c[5] * (0.1_f64 * t0) + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let t0 = self.c[0] * q.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(q[1]);
                let t1 = self.hill((0.7 * self.c[2].sin()).exp_m1(), (t0 / (2.0 + v[0] * v[0])));
                (1.6 + 0.5 * q[1].cos()).powi(3)
                    + self.c[4] * (1.4 + t0 * t0).log(3.0 + q[0] * q[0]) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System8 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System8 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] + self.c[1]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[2] * a * b)
                            .sum();
                        v[0].sin() + self.c[4] * (0.6 * t0.sin()).acos() + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..1 {
                    t0
                        += self.c[5] * (1.5 + 1.25_f64 * 1.25_f64).sqrt() * v[i]
                            / (i as f64 + 1.0);
                }
                (1.2 + t0 * t0).powf(self.c[0]) + self.c[1] * (0.6 * q[0].sin()).acos() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System9 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System9 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((self.c[1] + q[1]));
                let m1 = 1.0 + self.c[2] + Self::square((q[0] + q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = if q[0].atan() < self.c[3] {
                            (v[1] + q[1])
                        } else {
                            self.c[3] * (0.1_f64 + v[1])
                        };
                        let t1: f64 = v
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[4] * a * b)
                            .sum();
                        t0.cos() + self.c[0] * (t1 + self.c[5]) + t1
                    }
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [((1.5_f64 - q[1]) - (q[0] + 0.1_f64)), (-(-1.5_f64))]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System10 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System10 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.6 * 0.5_f64.sin()).asin());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let scale = |x: f64| x * self.c[1] + (0.3_f64 * v[0]);
                        let t0 = scale(v[0]) * 0.5;
                        (0.7 * t0.sin()).tan() + self.c[2] * (t0 / (2.0 + v[0] * v[0])) + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = (1.5_f64 - q[0]);
                if t0 > self.c[3] && v[0] < 0.6 {
                    t0 *= 0.5;
                    t0 += v[0].min(v[0]);
                }
                q[0].hypot(1.0 + v[0] * v[0]) + self.c[5] * self.c[4].copysign(0.3_f64) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System11 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System11 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] + q[1]));
                let m1 = 1.0 + self.c[1] + Self::square((0.7 * q[2].sin()).tan());
                let m2 = 1.0 + self.c[2] + Self::square((self.c[3] * q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let mut t0 = (0.3_f64 + v[1]);
                        if t0 > self.c[4] && q[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += (0.7 * q[2].sin()).exp2();
                        }
                        (0.6 * q[0].sin()).asin() + self.c[5] * (-t0) + t0
                    }
            }
            fn rayleigh(&self, v: [f64; 3]) -> f64 {
                let t0 = self.c[0] * v.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(v[2]);
                let mut t1 = (1.25_f64 - self.c[2]);
                if t1 > self.c[1] && v[0] < 0.6 {
                    t1 *= 0.5;
                    t1 += (v[1] - 0.5_f64);
                }
                v[1].copysign(t1) + self.c[3] * (-t0) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System12 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System12 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(q[0].max(q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = self.hill((-self.c[2]), (self.c[3] + v[0]));
                        let mut t1 = 0.0;
                        for i in 0..1 {
                            t1
                                += self.c[4] * (20.0 * q[0].to_radians()) * v[i]
                                    / (i as f64 + 1.0);
                        }
                        (0.6 * v[0].sin()).acos() + self.c[5] * (t1 * t1) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let t0 = self
                    .hill(
                        v[0].tanh(),
                        ({
                            let (s, c) = q[0].sin_cos();
                            s * self.c[1] + c
                        }),
                    );
                t0.min(v[0]) + self.c[2] * (0.5_f64 * t0) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System13 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System13 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((self.c[1] / (2.0 + q[1] * q[1])));
                let m1 = 1.0 + self.c[2] + Self::square((-q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let mut t0 = (q[0] - self.c[4]);
                        if t0 > self.c[3] && q[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += (self.c[5] - q[0]);
                        }
                        let t1 = self
                            .hill((v[0] / (2.0 + 2.0_f64 * 2.0_f64)), t0.copysign(self.c[1]));
                        t0.atan() + self.c[3] * (self.c[2] + t1) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let t0 = self.hill((v[0] - v[1]), (0.3_f64 - v[1]));
                t0.max(v[1]) + self.c[5] * t0.max(v[1]) + t0
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [
                    (-v[0].asinh()),
                    (1.4 + (0.7 * v[1].sin()).exp_m1() * (0.7 * v[1].sin()).exp_m1())
                        .log(3.0 + (q[0] / (2.0 + v[1] * v[1])) * (q[0] / (2.0 + v[1] * v[1]))),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System14 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System14 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((-q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let scale = |x: f64| x * self.c[1] + (1.7 + q[0] * q[0]).acosh();
                        let t0 = scale(v[0]) * 0.5;
                        let t1 = self.c[4].abs().min((1.5_f64 * q[0]));
                        (0.7 * v[0].sin()).sinh() + self.c[5] * (-t1) + t1
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System15 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System15 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(q[1].signum());
                let m1 = 1.0 + self.c[1] + Self::square((1.6 + 0.5 * self.c[2].cos()).powi(-2));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = self
                            .hill(
                                (1.4 + 0.1_f64 * 0.1_f64).log(3.0 + q[0] * q[0]),
                                (0.7 * q[1].sin()).exp2(),
                            );
                        let t1 = (v[1] / (2.0 + v[1] * v[1])).copysign((v[0] + v[0]));
                        (0.7 * v[0].sin()).cosh() + self.c[5] * (20.0 * q[0].to_radians()) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let scale = |x: f64| x * self.c[0] + (-q[1]);
                let t0 = scale(v[0]) * 0.5;
                let t1: f64 = q.iter().zip(v.iter()).map(|(a, b)| self.c[1] * a * b).sum();
                t1.mul_add(t0, self.c[2]) + self.c[3] * (t0 - v[1]) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System16 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System16 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] / (2.0 + self.c[1] * self.c[1])));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = self.c[2] * v.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(v[0]);
                        v[0].tanh() + self.c[3] * (1.5 + t0 * t0).log2() + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let scale = |x: f64| x * self.c[4] + (q[0] + v[0]);
                let t0 = scale(q[0]) * 0.5;
                ({
                    let (s, c) = t0.sin_cos();
                    s * q[0] + c
                }) + self.c[0] * (0.6 * t0.sin()).acos() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System17 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System17 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * q[1].sin()).exp());
                let m1 = 1.0 + self.c[1] + Self::square((0.02 * q[2].to_degrees()));
                let m2 = 1.0 + self.c[3] + Self::square((q[0] + 2.0_f64));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let t0 = self.hill((0.7 * 0.1_f64.sin()).sinh(), (q[0] * q[2]));
                        q[2].asinh() + self.c[0] * (0.6 * 0.5_f64.sin()).acos() + t0
                    }
            }
            fn rayleigh(&self, v: [f64; 3]) -> f64 {
                let t0 = ((v[1] + v[2]) + (v[0] * self.c[2]));
                let mut t1 = self.c[3];
                for (i, &x) in v.iter().enumerate() {
                    if i % 2 == 0 {
                        t1 += x * (1.7 + x * x).acosh();
                    } else {
                        t1 -= 0.5 * x;
                    }
                }
                (20.0 * t1.to_radians()) + self.c[4] * (1.5 + v[2] * v[2]).recip() + t1
            }
            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                [
                    ((1.6 + 0.5 * 1.5_f64.cos()).powi(1) + (0.6 * 0.3_f64.sin()).atanh()),
                    (0.6 * (1.2 + v[2] * v[2]).powf(self.c[5]).sin()).asin(),
                    ((q[1] - v[1]) + (1.5_f64 + q[1])),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System18 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System18 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.6 * self.c[1].sin()).acos());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = self.hill((0.3_f64 - self.c[3]), (q[0] + 2.0_f64));
                        (1.7 + v[0] * v[0]).acosh() + self.c[4] * (-t0) + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = self.c[5];
                for (i, &x) in v.iter().enumerate() {
                    if i % 2 == 0 {
                        t0 += x * (0.02 * 0.1_f64.to_degrees());
                    } else {
                        t0 -= 0.5 * x;
                    }
                }
                let mut t1 = self.c[0];
                for (i, &x) in q.iter().enumerate() {
                    if i % 2 == 0 {
                        t1 += x * (0.1_f64 + x);
                    } else {
                        t1 -= 0.5 * x;
                    }
                }
                (0.02 * q[0].to_degrees()) + self.c[1] * (q[0] / (2.0 + t1 * t1)) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System19 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System19 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((1.5_f64 * q[1]));
                let m1 = 1.0 + self.c[1] + Self::square(q[0].max(q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let mut t0 = self.c[2];
                        for (i, &x) in v.iter().enumerate() {
                            if i % 2 == 0 {
                                t0 += x * (self.c[3] + q[1]);
                            } else {
                                t0 -= 0.5 * x;
                            }
                        }
                        (0.6 * q[1].sin()).atanh() + self.c[4] * (v[1] * 3.0_f64) + t0
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System20 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System20 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((self.c[1] + q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = if (v[0] + q[0]) < self.c[2] {
                            (-v[0])
                        } else {
                            self.c[2] * (1.25_f64 + v[0])
                        };
                        let t1 = self.hill((3.0_f64 + q[0]), (-0.3_f64));
                        (1.5 + t0 * t0).sqrt() + self.c[5] * t1.clamp(-0.8, 0.9) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                let t0 = ((1.5 + v[0] * v[0]).sqrt() * (-v[0]));
                let mut t1 = self.c[1];
                for (i, &x) in v.iter().enumerate() {
                    if i % 2 == 0 {
                        t1 += x * (v[0] + 0.3_f64);
                    } else {
                        t1 -= 0.5 * x;
                    }
                }
                (1.5 + t0 * t0).recip() + self.c[3] * (1.5 + self.c[2] * self.c[2]).log10() + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System21 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System21 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.3_f64 / (2.0 + q[1] * q[1])));
                let m1 = 1.0 + self.c[1] + Self::square((0.6 * q[0].sin()).asin());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = ((v[1] - self.c[3]) + (1.25_f64 * q[1]));
                        let mut t1 = self.c[4];
                        for (i, &x) in v.iter().enumerate() {
                            if i % 2 == 0 {
                                t1 += x * (q[1] * 3.0_f64);
                            } else {
                                t1 -= 0.5 * x;
                            }
                        }
                        (2.5 + t0.sin()).cbrt() + self.c[0] * (-v[1]) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let mut t0 = self.c[1];
                for (i, &x) in v.iter().enumerate() {
                    if i % 2 == 0 {
                        t0 += x * (v[0] + v[1]);
                    } else {
                        t0 -= 0.5 * x;
                    }
                }
                let mut t1 = t0.atan2(2.0 + self.c[3] * self.c[3]);
                if t1 > self.c[2] && v[0] < 0.6 {
                    t1 *= 0.5;
                    t1 += (-0.5_f64);
                }
                (0.7 * t1.sin()).exp() + self.c[4] * (v[0] * 0.1_f64) + t1
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [(-(0.6 * self.c[5].sin()).asin()), (-(v[0] + v[1]))]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System22 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System22 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((1.5 + 0.5_f64 * 0.5_f64).log10());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = (-(q[0] - self.c[2]));
                        let t1 = self.c[3] * v.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(v[0]);
                        t1.abs() + self.c[5] * (self.c[4] / (2.0 + t0 * t0)) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let t0 = if (q[0] / (2.0 + q[0] * q[0])) < self.c[0] {
                    (0.7 * q[0].sin()).exp_m1()
                } else {
                    self.c[0] * (-v[0])
                };
                (0.7 * t0.sin()).exp2() + self.c[2] * (0.4 * v[0].cos()).ln_1p() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System23 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System23 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((1.5 + self.c[1] * self.c[1]).recip());
                let m1 = 1.0 + self.c[2] + Self::square(q[2].tanh());
                let m2 = 1.0 + self.c[3] + Self::square((q[0] / (2.0 + q[0] * q[0])));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let scale = |x: f64| x * self.c[4] + (0.7 * 2.0_f64.sin()).exp2();
                        let t0 = scale(v[0]) * 0.5;
                        let mut t1 = ({
                            let (s, c) = q[1].sin_cos();
                            s * self.c[0] + c
                        });
                        if t1 > self.c[5] && v[0] < 0.6 {
                            t1 *= 0.5;
                            t1 += 0.5_f64.atan();
                        }
                        v[1].signum() + self.c[2] * (v[0] + t1) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..3 {
                    t0 += self.c[3] * (0.7 * v[0].sin()).exp_m1() * v[i] / (i as f64 + 1.0);
                }
                (0.7 * q[2].sin()).exp_m1() + self.c[5] * (0.7 * t0.sin()).exp() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System24 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System24 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * 1.5_f64.sin()).cosh());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[1] * a * b)
                            .sum();
                        let t1 = self.c[2] * q.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(q[0]);
                        (1.6 + 0.5 * t0.cos()).powi(1) + self.c[3] * (1.5 + t1 * t1).log10() + t1
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System25 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System25 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * q[1].sin()).tan());
                let m1 = 1.0 + self.c[1]
                    + Self::square(
                        ({
                            let (s, c) = q[0].sin_cos();
                            s * q[0] + c
                        }),
                    );
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = if (2.0_f64 + self.c[3]) < self.c[2] {
                            (v[1] + 1.25_f64)
                        } else {
                            self.c[2] * self.c[4].copysign(self.c[5])
                        };
                        let mut t1 = 0.1_f64.atan();
                        if t1 > self.c[0] && q[0] < 0.6 {
                            t1 *= 0.5;
                            t1 += q[0].cos();
                        }
                        (1.3 + v[0] * v[0]).powf(q[1].sin()) + self.c[1] * (0.3_f64 - q[1]) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let t0 = if (0.1_f64 / (2.0 + 0.5_f64 * 0.5_f64)) < self.c[2] {
                    (q[0] - v[0])
                } else {
                    self.c[2] * (2.0_f64 - q[0])
                };
                let mut t1 = (0.6 * q[0].sin()).atanh();
                if t1 > self.c[3] && v[0] < 0.6 {
                    t1 *= 0.5;
                    t1 += (q[1] + q[0]);
                }
                (1.5 + t1 * t1).log2() + self.c[4] * (v[1] * 1.25_f64) + t1
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [
                    (0.7 * (1.4 + 1.5_f64 * 1.5_f64).log(3.0 + 1.25_f64 * 1.25_f64).sin())
                        .cosh(),
                    ((1.5 + v[0] * v[0]).recip() - (1.5 + self.c[5] * self.c[5]).ln()),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System26 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System26 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((1.5 + q[0] * q[0]).sqrt());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let mut t0 = (v[0] + v[0]);
                        if t0 > self.c[1] && q[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += v[0].max(v[0]);
                        }
                        let t1 = (1.5 + (v[0] + 1.25_f64) * (v[0] + 1.25_f64)).ln();
                        v[0].atan2(2.0 + t1 * t1) + self.c[4] * (t0 * self.c[3]) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                let mut t0 = v[0].mul_add(v[0], self.c[0]);
                if t0 > self.c[5] && v[0] < 0.6 {
                    t0 *= 0.5;
                    t0 += (0.1_f64 * v[0]);
                }
                (1.5 + t0 * t0).log10() + self.c[1] * (2.0_f64 + v[0]) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System27 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System27 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] - 0.3_f64));
                let m1 = 1.0 + self.c[1] + Self::square((0.6 * self.c[2].sin()).atanh());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = self.hill((v[1] + q[0]), (0.7 * 0.5_f64.sin()).exp_m1());
                        t0.hypot(1.0 + v[0] * v[0]) + self.c[4] * t0.cos() + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let t0 = (-(-q[0]));
                let t1 = self.hill(t0.asinh(), (1.5_f64 * self.c[1]));
                (0.4 * t1.cos()).ln_1p() + self.c[2] * (q[0] - v[0]) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System28 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System28 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] * q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = self.hill((q[0] * 0.1_f64), (-self.c[2]));
                        let t1 = self.hill((0.02 * q[0].to_degrees()), (-self.c[5]));
                        q[0].copysign(t1) + self.c[2] * self.c[1].hypot(1.0 + q[0] * q[0]) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..1 {
                    t0 += self.c[3] * (-self.c[4]) * v[i] / (i as f64 + 1.0);
                }
                q[0].sin() + self.c[0] * (-3.0_f64) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System29 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System29 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(self.c[1].signum());
                let m1 = 1.0 + self.c[2] + Self::square(q[2].tanh());
                let m2 = 1.0 + self.c[3] + Self::square((1.5 + q[0] * q[0]).recip());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let scale = |x: f64| x * self.c[4] + (v[2] * q[0]);
                        let t0 = scale(v[0]) * 0.5;
                        v[2].min(q[2]) + self.c[0] * (self.c[5] + v[0]) + t0
                    }
            }
            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                [
                    (-(1.5 + 1.5_f64 * 1.5_f64).sqrt()),
                    (0.7 * (-v[1]).sin()).exp(),
                    ((self.c[1] + 2.0_f64) * (-v[0])),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System30 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System30 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] + q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let scale = |x: f64| x * self.c[1] + (3.0_f64 - v[0]);
                        let t0 = scale(q[0]) * 0.5;
                        let mut t1 = (1.5 + t0 * t0).ln();
                        if t1 > self.c[2] && q[0] < 0.6 {
                            t1 *= 0.5;
                            t1 += (0.6 * v[0].sin()).asin();
                        }
                        t1.max(t0) + self.c[3] * (v[0] + v[0]) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = self.c[4];
                for (i, &x) in v.iter().enumerate() {
                    if i % 2 == 0 {
                        t0 += x * (0.7 * v[0].sin()).sinh();
                    } else {
                        t0 -= 0.5 * x;
                    }
                }
                (0.7 * t0.sin()).tan() + self.c[1] * (t0 * self.c[0]) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System31 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System31 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] / (2.0 + q[1] * q[1])));
                let m1 = 1.0 + self.c[1] + Self::square(q[0].atan());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let mut t0 = self.c[2];
                        for (i, &x) in v.iter().enumerate() {
                            if i % 2 == 0 {
                                t0 += x * (v[0] - v[1]);
                            } else {
                                t0 -= 0.5 * x;
                            }
                        }
                        q[1].clamp(-0.8, 0.9) + self.c[3] * (v[1] * v[0]) + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..2 {
                    t0 += self.c[4] * (v[i] - v[0]) * v[i] / (i as f64 + 1.0);
                }
                let t1 = (2.5 + (1.5 + t0 * t0).log10().sin()).cbrt();
                (0.6 * q[1].sin()).asin() + self.c[0] * (1.25_f64 + t0) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System32 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System32 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((-q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[1] * a * b)
                            .sum();
                        let scale = |x: f64| x * self.c[2] + (self.c[3] + 1.5_f64);
                        let t1 = scale(v[0]) * 0.5;
                        t0.mul_add(t0, self.c[4]) + self.c[5] * t0.cos() + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let t0: f64 = v.iter().zip(v.iter()).map(|(a, b)| self.c[0] * a * b).sum();
                let mut t1 = 0.0;
                for i in 0..1 {
                    t1 += self.c[1] * (0.7 * self.c[2].sin()).tan() * q[i] / (i as f64 + 1.0);
                }
                (0.6 * t1.sin()).acos() + self.c[3] * (0.3_f64 - t1) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System33 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System33 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] / (2.0 + q[1] * q[1])));
                let m1 = 1.0 + self.c[1] + Self::square((1.2 + q[0] * q[0]).powf(0.75));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = if (0.4 * self.c[3].cos()).ln_1p() < self.c[2] {
                            (q[0] + q[1])
                        } else {
                            self.c[2] * (2.5 + v[1].sin()).cbrt()
                        };
                        let mut t1 = q[0].atan2(2.0 + v[1] * v[1]);
                        if t1 > self.c[5] && q[0] < 0.6 {
                            t1 *= 0.5;
                            t1 += (t0 / (2.0 + t0 * t0));
                        }
                        ({
                            let (s, c) = t1.sin_cos();
                            s * v[1] + c
                        }) + self.c[1] * self.c[0].signum() + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let t0 = self.hill((-v[0]), (0.7 * v[0].sin()).exp2());
                t0.atan() + self.c[4] * (v[1] + v[1]) + t0
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [
                    ((0.7 * v[1].sin()).exp2() + (0.7 * q[1].sin()).tan()),
                    (1.5 + v[0] * v[0])
                        .log2()
                        .hypot(1.0 + (0.7 * v[1].sin()).exp2() * (0.7 * v[1].sin()).exp2()),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System34 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System34 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] - self.c[1]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[2] * a * b)
                            .sum();
                        (20.0 * v[0].to_radians()) + self.c[3] * (0.3_f64 - q[0]) + t0
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System35 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System35 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(q[1].atan());
                let m1 = 1.0 + self.c[1] + Self::square((q[2] + self.c[2]));
                let m2 = 1.0 + self.c[3] + Self::square((0.1_f64 / (2.0 + q[0] * q[0])));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let t0 = (1.6 + 0.5 * (3.0_f64 + self.c[5]).cos()).powi(1);
                        let t1 = (self.c[3] - 0.5_f64)
                            .atan2(
                                2.0
                                    + (self.c[4] / (2.0 + t0 * t0))
                                        * (self.c[4] / (2.0 + t0 * t0)),
                            );
                        (0.02 * t0.to_degrees()) + self.c[5] * (v[1] * t0) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..3 {
                    t0 += self.c[0] * (v[i] * v[i].abs()) * v[i] / (i as f64 + 1.0);
                }
                (0.7 * q[0].sin()).cosh() + self.c[2] * v[2].hypot(1.0 + self.c[1] * self.c[1])
                    + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System36 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System36 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(q[0].copysign(q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let mut t0 = (v[0] / (2.0 + self.c[2] * self.c[2]));
                        if t0 > self.c[1] && v[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += (0.7 * v[0].sin()).exp2();
                        }
                        let mut t1 = 0.0;
                        for i in 0..1 {
                            t1 += self.c[3] * (0.7 * q[i].sin()).tan() * q[i] / (i as f64 + 1.0);
                        }
                        (1.4 + q[0] * q[0]).log(3.0 + t1 * t1)
                            + self.c[5] * (0.6 * self.c[4].sin()).asin() + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                let t0 = self.c[0] * v.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(v[0]);
                t0.tanh() + self.c[2] * (self.c[1] - v[0]) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System37 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System37 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] * self.c[1]));
                let m1 = 1.0 + self.c[2] + Self::square((1.5 + q[0] * q[0]).ln());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let mut t0 = 0.0;
                        for i in 0..2 {
                            t0
                                += self.c[3] * (self.c[4] / (2.0 + 0.1_f64 * 0.1_f64)) * v[i]
                                    / (i as f64 + 1.0);
                        }
                        (1.5 + v[0] * v[0]).recip() + self.c[0] * self.c[5].max(v[0]) + t0
                    }
            }
            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let t0 = self.c[1] * v.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(v[1]);
                v[1].asinh() + self.c[2] * (t0 * v[1]) + t0
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [((q[1] * v[1]) - (20.0 * 0.5_f64.to_radians())), ((-v[0]) + (q[0] * q[0]))]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System38 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System38 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[0] / (2.0 + q[0] * q[0])));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = if (q[0] + self.c[2]) < self.c[1] {
                            (-v[0])
                        } else {
                            self.c[1] * (-2.0_f64)
                        };
                        let t1 = self.c[3] * v.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(v[0]);
                        (0.7 * t0.sin()).exp()
                            + self.c[5] * v[0].hypot(1.0 + self.c[4] * self.c[4]) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..1 {
                    t0
                        += self.c[0] * (v[i] / (2.0 + 1.5_f64 * 1.5_f64)) * v[i]
                            / (i as f64 + 1.0);
                }
                (1.7 + v[0] * v[0]).acosh() + self.c[2] * t0.signum() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System39 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System39 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] + self.c[1]));
                let m1 = 1.0 + self.c[2] + Self::square((1.5 + self.c[3] * self.c[3]).sqrt());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let mut t0 = v[0].sin();
                        if t0 > self.c[5] && v[0] < 0.6 {
                            t0 *= 0.5;
                            t0 += (0.6 * v[0].sin()).asin();
                        }
                        let t1: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[0] * a * b)
                            .sum();
                        (0.7 * v[0].sin()).exp2()
                            + self.c[2] * (t0 / (2.0 + self.c[1] * self.c[1])) + t1
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System40 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System40 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((1.5 + q[0] * q[0]).recip());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = self.c[2] * q.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(q[0]);
                        let mut t1 = self.c[3];
                        for (i, &x) in q.iter().enumerate() {
                            if i % 2 == 0 {
                                t1 += x * (1.7 + x * x).acosh();
                            } else {
                                t1 -= 0.5 * x;
                            }
                        }
                        (0.7 * t1.sin()).exp_m1() + self.c[4] * v[0].copysign(t0) + t1
                    }
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                let t0 = ((v[0] / (2.0 + v[0] * v[0])) - (v[0] / (2.0 + v[0] * v[0])));
                let t1 = self.hill((t0 * t0.abs()), (self.c[2] / (2.0 + v[0] * v[0])));
                (1.5 + t1 * t1).sqrt() + self.c[3] * (v[0] + t1) + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System41 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System41 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((1.7 + q[1] * q[1]).acosh());
                let m1 = 1.0 + self.c[1] + Self::square((0.6 * q[2].sin()).asin());
                let m2 = 1.0 + self.c[2] + Self::square((-q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let t0: f64 = q
                            .iter()
                            .zip(v.iter())
                            .map(|(a, b)| self.c[4] * a * b)
                            .sum();
                        (1.5 + q[1] * q[1]).ln() + self.c[5] * (1.5 + q[0] * q[0]).log10() + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let t0: f64 = q.iter().zip(v.iter()).map(|(a, b)| self.c[0] * a * b).sum();
                (2.5 + q[0].sin()).cbrt() + self.c[2] * self.c[1].min(q[2]) + t0
            }
            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                [
                    (-(self.c[3] - v[2])),
                    ((q[0] + q[2]) + (q[1] + q[1])),
                    ((q[1] * self.c[4]) - self.c[5].cos()),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System42 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System42 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((2.0_f64 + 0.5_f64));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = self
                            .hill(
                                ({
                                    let (s, c) = v[0].sin_cos();
                                    s * self.c[2] + c
                                }),
                                (q[0] + v[0]),
                            );
                        (1.5 + v[0] * v[0]).log2() + self.c[3] * (0.1_f64 - v[0]) + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let t0 = self.hill((v[0] - q[0]), (q[0] + v[0]));
                (t0 * t0.abs()) + self.c[5] * (v[0] + v[0]) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System43 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System43 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * q[1].sin()).cosh());
                let m1 = 1.0 + self.c[1] + Self::square(q[0].hypot(1.0 + self.c[2] * self.c[2]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = (0.7 * (1.5 + q[1] * q[1]).log2().sin()).exp();
                        (1.5 + q[1] * q[1]).log10() + self.c[5] * (20.0 * 1.5_f64.to_radians())
                            + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let mut t0 = 0.0;
                for i in 0..2 {
                    t0 += self.c[0] * (-q[1]) * q[i] / (i as f64 + 1.0);
                }
                let t1: f64 = v.iter().zip(v.iter()).map(|(a, b)| self.c[1] * a * b).sum();
                v[0].signum() + self.c[2] * (1.5 + q[1] * q[1]).sqrt() + t1
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System44 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System44 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(q[0].abs());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = (0.5_f64 + v[0]).sin();
                        (0.4 * v[0].cos()).ln_1p() + self.c[3] * (t0 - self.c[2]) + t0
                    }
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System45 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System45 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((q[1] + q[1]));
                let m1 = 1.0 + self.c[1] + Self::square((q[0] + q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = if (0.5_f64 - v[1]) < self.c[2] {
                            ({
                                let (s, c) = self.c[3].sin_cos();
                                s * 0.3_f64 + c
                            })
                        } else {
                            self.c[2] * (q[0] * q[1])
                        };
                        q[0].sin() + self.c[4] * (1.5_f64 + q[0]) + t0
                    }
            }
            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let t0 = if (self.c[0] * v[1]) < self.c[5] {
                    v[1].clamp(-0.8, 0.9)
                } else {
                    self.c[5] * (v[0] + self.c[1])
                };
                let t1 = (v[0].signum() - (1.3 + self.c[3] * self.c[3]).powf(0.1_f64.sin()));
                (1.3 + t1 * t1).powf(v[0].sin()) + self.c[5] * (v[0] + self.c[4]) + t1
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [
                    ((q[1] + self.c[0]) + (v[1] + q[0])),
                    (v[1].atan2(2.0 + v[0] * v[0]) + (0.02 * q[0].to_degrees())),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System46 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System46 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((self.c[1] + q[0]));
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = (self.c[3].mul_add(v[0], self.c[4])
                            - (1.5 + 2.0_f64 * 2.0_f64).recip());
                        let mut t1 = v[0].tanh();
                        if t1 > self.c[0] && v[0] < 0.6 {
                            t1 *= 0.5;
                            t1
                                += ({
                                    let (s, c) = t0.sin_cos();
                                    s * self.c[1] + c
                                });
                        }
                        t0.cos() + self.c[2] * (t0 - q[0]) + t1
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let mut t0 = self.c[3];
                for (i, &x) in q.iter().enumerate() {
                    if i % 2 == 0 {
                        t0 += x * (-v[0]);
                    } else {
                        t0 -= 0.5 * x;
                    }
                }
                q[0].atan2(2.0 + v[0] * v[0]) + self.c[5] * (self.c[4] - q[0]) + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System47 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System47 {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * q[1].sin()).exp_m1());
                let m1 = 1.0 + self.c[1] + Self::square((self.c[2] + q[2]));
                let m2 = 1.0 + self.c[3] + Self::square((3.0_f64 + q[0]));
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1] + 0.5 * m2 * v[2] * v[2]
                    - {
                        let t0 = if (1.5 + q[2] * q[2]).log2() < self.c[4] {
                            self.c[5].asinh()
                        } else {
                            self.c[4] * (-q[0])
                        };
                        (0.7 * v[0].sin()).tan() + self.c[0] * (1.7 + 0.3_f64 * 0.3_f64).acosh()
                            + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let mut t0 = (0.7 * 1.25_f64.sin()).exp2();
                if t0 > self.c[1] && q[0] < 0.6 {
                    t0 *= 0.5;
                    t0 += 2.0_f64.asinh();
                }
                q[0].hypot(1.0 + v[2] * v[2]) + self.c[2] * q[0].tanh() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System48 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System48 {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square(self.c[1].atan());
                0.5 * m0 * v[0] * v[0]
                    - {
                        let t0 = (-(v[0] - q[0]));
                        (0.6 * v[0].sin()).asin()
                            + self.c[4] * (1.6 + 0.5 * self.c[3].cos()).powi(-2) + t0
                    }
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let t0 = self.c[5] * v.iter().fold(0.25, |total, x| total + x * x)
                    + Self::square(v[0]);
                q[0].copysign(q[0]) + self.c[1] * self.c[0].signum() + t0
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
        pub struct System49 {
            pub c: [f64; 6],
        }
        #[rayleigh_system(derivatives = $engine)]
        impl System49 {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let m0 = 1.0 + self.c[0] + Self::square((0.7 * q[1].sin()).sinh());
                let m1 = 1.0 + self.c[1] + Self::square(q[0].abs());
                0.5 * m0 * v[0] * v[0] + 0.5 * m1 * v[1] * v[1]
                    - {
                        let t0 = self
                            .hill((0.4 * v[0].cos()).ln_1p(), (0.6 * v[1].sin()).asin());
                        let t1 = self.c[3] * q.iter().fold(0.25, |total, x| total + x * x)
                            + Self::square(q[1]);
                        (0.6 * t1.sin()).acos() + self.c[4] * (v[1] + t1) + t1
                    }
            }
            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [
                    ((q[1] - self.c[5]) / (2.0 + (q[1] + 1.5_f64) * (q[1] + 1.5_f64))),
                    ((v[0] + 0.1_f64) - (self.c[0] * 2.0_f64)),
                ]
            }
            fn square(x: f64) -> f64 {
                x * x
            }
            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
    };
}

/// `$each!(name, n, rayleigh?, force?)` for every system.
macro_rules! every_system {
    ($each:ident) => {
        [
            $each!(System0, 1, [rayleigh], []),
            $each!(System1, 2, [rayleigh], [force]),
            $each!(System2, 1, [rayleigh], []),
            $each!(System3, 2, [rayleigh], []),
            $each!(System4, 1, [], []),
            $each!(System5, 3, [rayleigh], [force]),
            $each!(System6, 1, [rayleigh], []),
            $each!(System7, 2, [rayleigh], []),
            $each!(System8, 1, [rayleigh], []),
            $each!(System9, 2, [], [force]),
            $each!(System10, 1, [rayleigh], []),
            $each!(System11, 3, [rayleigh], []),
            $each!(System12, 1, [rayleigh], []),
            $each!(System13, 2, [rayleigh], [force]),
            $each!(System14, 1, [], []),
            $each!(System15, 2, [rayleigh], []),
            $each!(System16, 1, [rayleigh], []),
            $each!(System17, 3, [rayleigh], [force]),
            $each!(System18, 1, [rayleigh], []),
            $each!(System19, 2, [], []),
            $each!(System20, 1, [rayleigh], []),
            $each!(System21, 2, [rayleigh], [force]),
            $each!(System22, 1, [rayleigh], []),
            $each!(System23, 3, [rayleigh], []),
            $each!(System24, 1, [], []),
            $each!(System25, 2, [rayleigh], [force]),
            $each!(System26, 1, [rayleigh], []),
            $each!(System27, 2, [rayleigh], []),
            $each!(System28, 1, [rayleigh], []),
            $each!(System29, 3, [], [force]),
            $each!(System30, 1, [rayleigh], []),
            $each!(System31, 2, [rayleigh], []),
            $each!(System32, 1, [rayleigh], []),
            $each!(System33, 2, [rayleigh], [force]),
            $each!(System34, 1, [], []),
            $each!(System35, 3, [rayleigh], []),
            $each!(System36, 1, [rayleigh], []),
            $each!(System37, 2, [rayleigh], [force]),
            $each!(System38, 1, [rayleigh], []),
            $each!(System39, 2, [], []),
            $each!(System40, 1, [rayleigh], []),
            $each!(System41, 3, [rayleigh], [force]),
            $each!(System42, 1, [rayleigh], []),
            $each!(System43, 2, [rayleigh], []),
            $each!(System44, 1, [], []),
            $each!(System45, 2, [rayleigh], [force]),
            $each!(System46, 1, [rayleigh], []),
            $each!(System47, 3, [rayleigh], []),
            $each!(System48, 1, [rayleigh], []),
            $each!(System49, 2, [], [force]),
        ]
    };
}
