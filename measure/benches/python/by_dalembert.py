from dalembert_scenes import HenonHeiles, Plane
from starts import END, GONE, OPENINGS


def openings():
    return [Plane(q=way, value=GONE, direction=1, terminal=True) for way in OPENINGS]


def escape_times(q, v, h, threads):
    ends = HenonHeiles().ensemble(
        q=q, v=v, h=h, steps=round(END / h), rule="blanes_moan_6", events=openings(), threads=threads
    )
    return ends.t
