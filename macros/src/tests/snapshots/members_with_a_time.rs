impl ::dalembert::generated::Gathered<1> for DrivenShaken<'_> {
        type Fields<'s, const W: usize> = ([Members<f64, W>; 3], Members<f64, W>)
        where
            Self: 's;
        fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W> {
            (
                Members::of_each(
                    systems
                        .map(|system| {
                            let u = system.u;
                            [u[0], system.system.m, system.system.a]
                        }),
                ),
                Members(systems.map(|system| system.t)),
            )
        }
        #[inline(always)]
        fn later_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            elapsed: &Members<f64, W>,
        ) -> Self::Fields<'s, W>
        where
            Self: 's,
        {
            let (known, t) = *fields;
            (known, t + *elapsed)
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::ExplicitInLanes<1> for DrivenShaken<'_> {
        #[inline(always)]
        fn velocity_momenta_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            v: &MemberVector<f64, 1, W>,
            _h: f64,
        ) -> [MemberVector<f64, 1, W>; 2]
        where
            Self: 's,
        {
            let ([_, m, _], _) = *fields;
            let t1 = m * v[0];
            [[t1], [t1]]
        }
        #[inline(always)]
        fn configuration_force_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            q: &MemberVector<f64, 1, W>,
        ) -> MemberVector<f64, 1, W>
        where
            Self: 's,
        {
            let ([t1, _, a], t) = *fields;
            [t1 - (1.0 + t.sin() * a) * q[0].sin()]
        }
    }
impl ::dalembert::generated::Gathered<1> for GrowingAtTime<'_> {
        type Fields<'s, const W: usize> = ([Members<f64, W>; 1], Members<f64, W>)
        where
            Self: 's;
        fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W> {
            (
                Members::of_each(systems.map(|system| [system.system.m])),
                Members(systems.map(|system| system.t)),
            )
        }
        #[inline(always)]
        fn later_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            elapsed: &Members<f64, W>,
        ) -> Self::Fields<'s, W>
        where
            Self: 's,
        {
            let (known, t) = *fields;
            (known, t + *elapsed)
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::ForcedLagrangianInLanes<1> for GrowingAtTime<'_> {
        type Kept<const W: usize> = [Members<f64, W>; 2];
        type AnchorsInLanes<const W: usize> = (
            [::dalembert::generated::Angle<Members<f64, W>>; 1],
            [::dalembert::generated::Reciprocal<Members<f64, W>>; 1],
        );
        #[inline(always)]
        fn rates_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            anchors: &mut Self::AnchorsInLanes<W>,
            q: &MemberVector<f64, 1, W>,
            v: &MemberVector<f64, 1, W>,
        ) -> (MemberVector<f64, 1, W>, Self::Kept<W>)
        where
            Self: 's,
        {
            let ([m], t) = *fields;
            let (angles, reciprocals) = anchors;
            let t1 = t * t + m;
            let sin_q0 = angles[0].sin_cos(q[0]).0;
            let t2 = reciprocals[0].of(t1);
            ([-sin_q0], [t1 * v[0], t2])
        }
        #[inline(always)]
        fn corrections_in_lanes<'s, const W: usize>(
            _fields: &Self::Fields<'s, W>,
            kept: &Self::Kept<W>,
            _v: &MemberVector<f64, 1, W>,
            p: &MemberVector<f64, 1, W>,
        ) -> [MemberVector<f64, 1, W>; 2]
        where
            Self: 's,
        {
            let [t1, t2] = *kept;
            let residual0 = p[0] - t1;
            [[residual0], [t2 * residual0]]
        }
    }
};