"""Run by LibreLane's own Python: CONFIG PDK_ROOT [LAST_STEP]: loads a design as `librelane` does; prints it, or the
metrics after LAST_STEP, as the last line, in JSON. All before are LibreLane's messages."""

import json
import sys

from librelane.flows import Flow

config, root, *last = sys.argv[1:]
flow = Flow.factory.get("Classic")(config, pdk="sky130A", pdk_root=root)
if last:
    print(json.dumps(dict(flow.start(tag="test", to=last[0]).metrics), default=float))
else:
    print(json.dumps(dict(flow.config), default=str))
