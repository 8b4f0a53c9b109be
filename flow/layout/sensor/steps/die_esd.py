"""Electrostatic discharges into each pad of the die."""

import json
from collections.abc import Iterable, Mapping
from typing import Any

from joblib import Parallel, delayed

from talbot.base.steps import Files, Step
from talbot.flow.layout.sensor import esd
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.pads import esd_models, pad_process


class DieEsd(Step[PdkParameters]):
    """Pulses of a human body and of a charged device into each pad, with the clamps that its segment has.

    esd_clamps, esd_core_clamps: pads of the pads' supply and of the core's in the segment that has the fewest.
    esd_pad_v: largest voltage at a pad. esd_core_v: at the core's supply, whose transistors have thin oxide. Both of a
    human body's pulse. core_leak_ua, core_rise_ua, core_ripple_ua: see `esd.Quiet`, the first at ss, the others at ff.
    """

    name = "die_esd"
    inputs = {"spice": "die_pads.spice", "plan": "die_plan.plan"}
    outputs = {"report": "esd.json"}
    metrics = {"esd_clamps": "", "esd_core_clamps": "", "esd_pad_v": "V", "esd_core_v": "V"}
    metrics |= {"core_leak_ua": "uA", "core_rise_ua": "uA", "core_ripple_ua": "uA"}
    tools = ("ngspice",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        pdk = self.parameters.pdk
        process, plan = pad_process(pdk), json.loads(inputs["plan"].read_text(encoding="utf-8"))
        counts = {net: fewest(plan["ring"], net, process.supplies[net]) for net in (esd.SUPPLY, esd.CORE)}
        models, spice = esd_models(pdk), inputs["spice"].read_text(encoding="utf-8")
        lines = models.lines(spice)
        jobs = (
            delayed(esd.stress)(lines, process, *case, *(n - (case[1] == net) for net, n in counts.items()))
            for case in esd.cases(process)
        )
        stresses: Any = Parallel(n_jobs=-1, prefer="threads")(jobs)  # joblib has no types
        report = json.dumps([stress._asdict() for stress in stresses], indent=1)
        outputs["report"].write_text(report + "\n", encoding="utf-8")
        body = [stress for stress in stresses if stress.pulse == esd.HBM.name]
        worst = {"esd_pad_v": max(stress.pad for stress in body), "esd_core_v": max(stress.core for stress in body)}
        clamps = {"esd_clamps": counts[esd.SUPPLY], "esd_core_clamps": counts[esd.CORE]}
        quiet = esd.quiet(models.lines(spice, "ss", leakage=True), models.lines(spice, "ff"), process)
        currents = {f"core_{name}_ua": round(1e6 * ampere, 3) for name, ampere in quiet._asdict().items()}
        return clamps | {name: round(volts, 2) for name, volts in worst.items()} | currents


def fewest(ring: Iterable[Mapping[str, Any]], pin: str, cell: str) -> int:
    """Return the number of pads ``cell`` on that net of the track ``pin`` which has the fewest. ring: of the plan."""
    counts = dict[str, int]()
    for place in ring:
        if pin in place["nets"]:
            net = place["nets"][pin]
            counts[net] = counts.get(net, 0) + (place["cell"] == cell)
    return min(counts.values())
