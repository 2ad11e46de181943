"""Four parts of the study of henon_heiles.py: what a task of a Slurm array does, as array.sbatch starts it.

    python slurm_array.py FOLDER MEMBERS TASK
"""

import os
import sys

from henon_heiles import part, parts

folder, members, task = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
for first, last in parts(members)[4 * task : 4 * task + 4]:
    print(*part(first, last, folder, threads=int(os.environ.get("SLURM_CPUS_PER_TASK", 1))), flush=True)
