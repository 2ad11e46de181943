impl ::dalembert::generated::Gathered<1> for Follower {
        type Fields<'s, const W: usize> = ([Members<f64, W>; 1], [&'s Self; W])
        where
            Self: 's;
        fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W> {
            (Members::of_each(systems.map(|system| [system.k])), systems)
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::DiscreteInLanes<::dalembert::generated::Midpoint, 1>
    for Follower {
        #[inline(always)]
        fn step_kernel_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            q0: &MemberVector<f64, 1, W>,
            v: &MemberVector<f64, 1, W>,
            h: f64,
        ) -> (MemberVector<f64, 1, W>, [MemberVector<f64, 1, W>; 1])
        where
            Self: 's,
        {
            let ([k], systems) = *fields;
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let [lift, cam_slope, cam_curvature, ..] = q[0]
                .on_each(
                    &systems,
                    |system, x| Curve::<f64>::derivatives(&system.cam, x),
                );
            let t1 = 0.5 * v[0] * v[0];
            let [drag, drag_slope, drag_curvature, ..] = q[0].on(&Self::DRAG);
            let t2 = k * lift;
            let t3 = half * half;
            (
                [v[0] - t3 * t1 * drag_slope + half * (cam_slope * t2 + v[0] * drag)],
                [
                    [
                        1.0 + half * drag
                            - t3
                                * (half * t1 * drag_curvature - k * cam_slope * cam_slope
                                    - cam_curvature * t2),
                    ],
                ],
            )
        }
        #[inline(always)]
        fn momenta_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            q0: &MemberVector<f64, 1, W>,
            v: &MemberVector<f64, 1, W>,
            h: f64,
        ) -> [MemberVector<f64, 1, W>; 2]
        where
            Self: 's,
        {
            let ([k], systems) = *fields;
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let [lift, cam_slope, ..] = q[0]
                .on_each(
                    &systems,
                    |system, x| Curve::<f64>::derivatives(&system.cam, x),
                );
            let [drag, drag_slope, ..] = q[0].on(&Self::DRAG);
            let t1 = half * (k * lift * cam_slope + v[0] * drag);
            let t2 = v[0] - 0.5 * half * half * v[0] * v[0] * drag_slope;
            [[t1 + t2], [t2 - t1]]
        }
    }