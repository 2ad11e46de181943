from dalembert_scenes import Blocks

from blocks import END, MU, C, K, M, Q, V

BLOCKS = Blocks(m=M, k=K, mu=MU, c=C)


def at_rest(h):
    steps = round(END / h)
    return BLOCKS.run(h=END / steps, steps=steps, every=steps, q=Q, v=V).q[-1]
