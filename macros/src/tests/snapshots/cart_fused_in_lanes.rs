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
        type Kept<const W: usize> = [Members<f64, W>; 3];
        type AnchorsInLanes<const W: usize> = (
            [::dalembert::generated::Angle<Members<f64, W>, true>; 1],
            [::dalembert::generated::Reciprocal<Members<f64, W>, true>; 1],
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
            let dl_dreach = v[0].mul_add(v[1], Members::<f64, W>::splat(1.0));
            let t3 = t1 * reach;
            let t4 = reciprocals[0].of((-reach).mul_add(t3, l_squared));
            (
                [a.powf(q[0]) + t2, -v[1].mul_add(c, l * dl_dreach * sin_q1)],
                [reach, t4, -t3],
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
            let [_, m, l_squared, _, _, _, _, t1] = *fields;
            let [reach, t2, t3] = *kept;
            let t4 = -v[0];
            let t5 = -v[1];
            let residual0 = t5.mul_add(reach, t4.mul_add(m, p[0]));
            let residual1 = t5.mul_add(l_squared, t4.mul_add(reach, p[1]));
            let t6 = t2 * t3.mul_add(residual0, residual1);
            [[residual0, residual1], [t3.mul_add(t6, t1 * residual0), t6]]
        }
    }
};