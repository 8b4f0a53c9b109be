"""Electrostatic discharges into each pad of the die."""

import json
from typing import Any

from joblib import Parallel, delayed

from talbot.base.steps import Files, Step
from talbot.flow.layout.sensor import esd
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.pads import esd_models, pad_process


class DieEsd(Step[PdkParameters]):
    """Pulses of a human body and of a charged device into each pad, with the clamps that its segment has.

    esd_clamps: pads of the pads' supply in the segment that has the fewest. esd_pad_v: largest voltage at a pad.
    esd_core_v: at the core's supply, whose transistors have thin oxide. Both of a human body's pulse.
    """

    name = "die_esd"
    inputs = {"spice": "die_pads.spice", "plan": "die_plan.plan"}
    outputs = {"report": "esd.json"}
    metrics = {"esd_clamps": "", "esd_pad_v": "V", "esd_core_v": "V"}
    tools = ("ngspice",)

    def run(self, inputs: Files, outputs: Files) -> dict[str, Any]:
        pdk = self.parameters.pdk
        process, plan = pad_process(pdk), json.loads(inputs["plan"].read_text(encoding="utf-8"))
        cell = process.supplies[esd.SUPPLY]
        nets = [place["nets"][esd.SUPPLY] for place in plan["ring"] if place["cell"] == cell]
        clamps = min(nets.count(net) for net in set(nets))
        lines = esd_models(pdk).lines(inputs["spice"].read_text(encoding="utf-8"))
        jobs = (delayed(esd.stress)(lines, process, *case, clamps) for case in esd.cases(process))
        stresses: Any = Parallel(n_jobs=-1, prefer="threads")(jobs)  # joblib has no types
        report = json.dumps([stress._asdict() for stress in stresses], indent=1)
        outputs["report"].write_text(report + "\n", encoding="utf-8")
        body = [stress for stress in stresses if stress.pulse == esd.HBM.name]
        worst = {"esd_pad_v": max(stress.pad for stress in body), "esd_core_v": max(stress.core for stress in body)}
        return {"esd_clamps": clamps, **{name: round(volts, 2) for name, volts in worst.items()}}
