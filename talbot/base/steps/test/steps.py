"""Steps for the tests of the runner. Each runs in a new process, which imports this file and no pytest."""

import os
import time
from dataclasses import dataclass, field

from talbot.base.steps import Step


def waited(condition):
    """Whether ``condition`` came true within 200 s."""
    end = time.monotonic() + 200
    while not condition() and time.monotonic() < end:
        time.sleep(0.05)
    return condition()


@dataclass(frozen=True)
class Times:
    times: int = field(default=2, metadata={"unit": "1"})


class Repeat(Step):
    name = "repeat"
    inputs = {"text": "text"}
    outputs = {"text": "out.txt"}
    Parameters = Times
    metrics = {"length": "B"}

    def run(self, inputs, outputs):
        made = inputs["text"].read_text() * self.parameters.times
        outputs["text"].write_text(made)
        return {"length": len(made)}


class Again(Repeat):
    name = "again"
    inputs = {"text": "repeat.text"}


class Careless(Repeat):
    name = "careless"

    def run(self, inputs, outputs):
        outputs["text"].with_name("more.txt").write_text("")
        return {"length": 0}


class Crash(Repeat):
    name = "crash"

    def run(self, inputs, outputs):
        os._exit(3)


class Plain(Repeat):
    """Tells the paths that it gets."""

    name = "plain"

    def run(self, inputs, outputs):
        outputs["text"].write_text(f"{inputs['text']} {outputs['text']}")
        return {"length": 0}


class Meet(Repeat):
    """Waits for the other of two to be there, too."""

    name = "meet"

    def run(self, inputs, outputs):
        here = inputs["text"].parent / self.name
        here.write_text("")
        other = here.with_name({"meet": "greet", "greet": "meet"}[self.name])
        outputs["text"].write_text(str(waited(other.exists)))
        return {"length": 0}


class Greet(Meet):
    name = "greet"


class Both(Repeat):
    name = "both"
    inputs = {"text": "meet.text", "more": "greet.text"}

    def run(self, inputs, outputs):
        outputs["text"].write_text(inputs["text"].read_text() + inputs["more"].read_text())
        return {"length": 8}


class Priority(Again):
    name = "priority"

    def run(self, inputs, outputs):
        outputs["text"].write_text(str(os.nice(0)))
        return {"length": 0}


class Long(Repeat):
    name = "long"

    def run(self, inputs, outputs):
        time.sleep(600)


class Last(Both):
    """Tells others, which have taken all cores, that the end of a chain was reached."""

    name = "last"
    inputs = {"text": "again.text"}

    def run(self, inputs, outputs):
        outputs["text"].write_text(inputs["text"].read_text())
        (inputs["text"].parents[1] / "last").write_text("")
        return {"length": 0}


class Patient(Repeat):
    """Ends when `Last` has run."""

    def __init__(self, number):
        super().__init__(Times())
        self.name = f"patient{number}"

    def run(self, inputs, outputs):
        outputs["text"].write_text(str(waited((outputs["text"].parents[1] / "last").exists)))
        return {"length": 0}


class Reader(Repeat):
    name = "reader"
    inputs = {"text": "last.text"}


class Circle(Repeat):
    name = "circle"
    inputs = {"text": "turn.text"}


class Turn(Repeat):
    name = "turn"
    inputs = {"text": "circle.text"}


class Order(Repeat):
    name = "order"

    def run(self, inputs, outputs):
        outputs["text"].write_text(" ".join({str(n) for n in range(100)}))
        return {"length": 0}


class Tool(Repeat):
    """A tool that would run for a minute and writes its process number to the given file."""

    name = "tool"

    def run(self, inputs, outputs):
        from talbot.base.tools import run

        run(["sh", "-c", f"echo $$ > {inputs['text']}; exec sleep 60"])
        return {"length": 0}
