import sys, tempfile
from pathlib import Path
from concurrent.futures import ThreadPoolExecutor
from attacks.environments import *
root=Path(tempfile.mkdtemp()); launcher=root/"launch"/"ribbonopt"; launcher.parent.mkdir(); launcher.write_text(LAUNCHER)
pick=sys.argv[1:]
n=0
for env in environments():
    if pick and not any(p in env.label for p in pick): continue
    for verb in VERBS:
        n+=1
        f=root/f"r{n}"
        run=run_in(env,verb,f,launcher)
        fault=fault_of(env,run,f)
        if fault: print(f"{env.label:30} {verb:9} {run.seconds:.1f}s {run.status}: {fault[:400]!r}",flush=True)
print(n)
