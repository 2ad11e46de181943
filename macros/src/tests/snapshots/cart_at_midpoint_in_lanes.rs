impl ::dalembert::generated::Gathered<2> for Cart {
        type Fields<'s, const W: usize> = [Members<f64, W>; 9] where Self: 's;
        fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W> {
            Members::of_each(
                systems
                    .map(|system| {
                        let l = system.l;
                        let k = system.k;
                        let a = system.a;
                        [l, system.m, l * l, system.end, k, system.c, a, -k, a.ln()]
                    }),
            )
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::DiscreteInLanes<::dalembert::generated::Midpoint, 2>
    for Cart {
        #[inline(always)]
        fn step_kernel_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            q0: &MemberVector<f64, 2, W>,
            v: &MemberVector<f64, 2, W>,
            h: f64,
        ) -> (MemberVector<f64, 2, W>, [MemberVector<f64, 2, W>; 2])
        where
            Self: 's,
        {
            let [l, m, l_squared, end, k, c, a, t1, ln_a] = *fields;
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let reach = l * cos_q1;
            let t2 = end.less(q[0]);
            let t3 = a.powf(q[0]);
            let t4 = Members::select(
                t2,
                -k * (q[0] - end),
                Members::<f64, W>::splat(0.0),
            );
            let dl_dreach = 1.0 + v[0] * v[1];
            let t5 = Members::select(t2, t1, Members::<f64, W>::splat(0.0));
            let t6 = half * half;
            let t7 = l * half * v[1] * sin_q1;
            (
                [
                    v[1] * reach + m * v[0] - half * (t3 + t4),
                    v[0] * reach + l_squared * v[1]
                        - half * (0.0 - l * dl_dreach * sin_q1 - c * v[1]),
                ],
                [
                    [m - t6 * t5 - ln_a * half * half * t3, reach - t7],
                    [reach + t7, l_squared + c * half + t6 * reach * dl_dreach],
                ],
            )
        }
        #[inline(always)]
        fn momenta_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            q0: &MemberVector<f64, 2, W>,
            v: &MemberVector<f64, 2, W>,
            h: f64,
        ) -> [MemberVector<f64, 2, W>; 2]
        where
            Self: 's,
        {
            let [l, m, l_squared, end, k, c, a, _, _] = *fields;
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let reach = l * cos_q1;
            let t1 = Members::select(
                end.less(q[0]),
                -k * (q[0] - end),
                Members::<f64, W>::splat(0.0),
            );
            let dl_dreach = 1.0 + v[0] * v[1];
            let t2 = v[0] * reach + l_squared * v[1];
            let t3 = v[1] * reach + m * v[0];
            let t4 = half * (a.powf(q[0]) + t1);
            let t5 = half * (0.0 - l * dl_dreach * sin_q1 - c * v[1]);
            [[t3 - t4, t2 - t5], [t3 + t4, t2 + t5]]
        }
    }