"""What a run is doing: a bar on a terminal, a line a long step elsewhere."""

import sys

from tqdm import tqdm


class Steps:
    """A bar over the steps named in ``names``; `note` is called with a step's name, or with a line about it."""

    def __init__(self, names):
        self.names = list(names)
        self.bar = tqdm(
            total=len(self.names),
            file=sys.stderr,
            leave=False,
            disable=None,
            bar_format="{n_fmt}/{total_fmt} |{bar:24}| {desc} [{elapsed}]",
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.bar.close()

    def note(self, text):
        if text in self.names:
            self.bar.n = self.names.index(text)
        elif self.bar.disable:
            print(f"  {text} ...", file=sys.stderr, flush=True)
        self.bar.set_description_str(text)
