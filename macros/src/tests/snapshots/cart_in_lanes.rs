impl ::dalembert::generated::Gathered<2> for Cart {
        type Fields<'s, const W: usize> = [Members<f64, W>; 8] where Self: 's;
        fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W> {
            Members::of_each(
                systems
                    .map(|system| {
                        let l = system.l;
                        let m = system.m;
                        [l, m, l * l, system.end, system.k, system.c, system.a, 1.0 / m]
                    }),
            )
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::ForcedLagrangianInLanes<2> for Cart {
        type Kept<const W: usize> = [Members<f64, W>; 4];
        type AnchorsInLanes<const W: usize> = (
            [::dalembert::generated::Angle<Members<f64, W>>; 1],
            [::dalembert::generated::Reciprocal<Members<f64, W>>; 1],
        );
        #[inline(always)]
        fn rates_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            anchors: &mut Self::AnchorsInLanes<W>,
            q: &MemberVector<f64, 2, W>,
            v: &MemberVector<f64, 2, W>,
        ) -> (MemberVector<f64, 2, W>, Self::Kept<W>)
        where
            Self: 's,
        {
            let [l, _, l_squared, end, k, c, a, t1] = *fields;
            let (angles, reciprocals) = anchors;
            let (sin_q1, cos_q1) = angles[0].sin_cos(q[1]);
            let reach = l * cos_q1;
            let t2 = Members::select(
                end.less(q[0]),
                -k * (q[0] - end),
                Members::<f64, W>::splat(0.0),
            );
            let dl_dreach = 1.0 + v[0] * v[1];
            let t3 = t1 * reach;
            let t4 = reciprocals[0].of(l_squared - reach * t3);
            (
                [a.powf(q[0]) + t2, -(l * dl_dreach * sin_q1 + c * v[1])],
                [v[0] * reach, v[1] * reach, t3, t4],
            )
        }
        #[inline(always)]
        fn corrections_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            kept: &Self::Kept<W>,
            v: &MemberVector<f64, 2, W>,
            p: &MemberVector<f64, 2, W>,
        ) -> [MemberVector<f64, 2, W>; 2]
        where
            Self: 's,
        {
            let [_, m, l_squared, _, _, _, _, t3] = *fields;
            let [t1, t2, t4, t5] = *kept;
            let residual0 = p[0] - m * v[0] - t2;
            let residual1 = p[1] - t1 - l_squared * v[1];
            let t6 = t5 * (residual1 - t4 * residual0);
            [[residual0, residual1], [t3 * residual0 - t4 * t6, t6]]
        }
    }
};