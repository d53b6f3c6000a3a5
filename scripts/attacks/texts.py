import random
def hostile(chance):
    return chance.choice(["../evil","$\\frac{$","\x1b[31m","a"*300,"x\u202ey","<script>","=1+1","\ud800","","."," ","CON"])
