"""Evaluated points of searches, in one SQLite file that Optuna and optuna-dashboard open.

SQLite: a transaction is whole or absent, after a kill and on a full disk, too. (A journal file's last line is not, and
a server would have to run.) One process writes: workers return what they found. A search has studies: its digest
with /small, /full and /thesis; each trial is one evaluated point, with figures and picture.
"""

import json
from collections.abc import Mapping, Sequence
from errno import ENOSPC
from os import strerror
from pathlib import Path
from typing import Any

import optuna
from alembic.util.exc import CommandError
from optuna.exceptions import OptunaError
from optuna.storages import RDBStorage
from optuna.trial import TrialState, create_trial
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.pool import NullPool

from talbot.base.check import work_begins
from talbot.base.files import atomic, held
from talbot.models.parameters import ParameterError

Distributions = Mapping[str, optuna.distributions.BaseDistribution]
RECORD = "record"
# No database, one of another version of Optuna, or a value in it that is damaged
DAMAGED = SQLAlchemyError, CommandError, RuntimeError, OptunaError, ValueError, LookupError, TypeError, AssertionError


class Store:
    """The store at ``path``, made where there is none. Raises ParameterError for a file that is none."""

    def __init__(self, path: Path, digest: str, directions: Sequence[Any]) -> None:
        work_begins()
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        self.path, self.digest, self.directions = path, digest, list(directions)
        path.parent.mkdir(parents=True, exist_ok=True)
        with held(path.parent):  # another search may begin here, too
            if not path.exists():
                with atomic(path) as part:
                    _close(_storage(part))
        storage = None
        try:
            storage = self._storage = _storage(path)
            self._studies = {name: self._study(name) for name in ("small", "full", "thesis")}
        except DAMAGED as error:
            if storage:
                _close(storage)
            _raise_full(error, path)
            raise _no_store(path, error) from None

    def _study(self, name: str) -> optuna.Study:
        return optuna.create_study(
            storage=self._storage, study_name=f"{self.digest}/{name}", directions=self.directions, load_if_exists=True
        )

    def records(self) -> dict[tuple[str, str], dict[str, Any]]:
        """Records by fidelity and the JSON of the values. Raises ParameterError for a file that is damaged."""
        out = {}
        try:
            for name, study in self._studies.items():
                for trial in study.get_trials(deepcopy=False):
                    if RECORD in trial.user_attrs:
                        out[name, key(trial.params)] = trial.user_attrs[RECORD]
        except DAMAGED as error:
            self.close()
            raise _no_store(self.path, error) from None
        return out

    def add(
        self,
        fidelity: str,
        values: Mapping[str, Any],
        distributions: Distributions,
        objectives: Sequence[float] | None,
        record: Mapping[str, Any],
    ) -> None:
        """Keep a point. objectives: None of one that failed. Raises OSError where the disk is full."""
        trial = create_trial(
            state=TrialState.FAIL if objectives is None else TrialState.COMPLETE,
            values=None if objectives is None else list(objectives),
            params=dict(values),
            distributions=dict(distributions),
            user_attrs={RECORD: dict(record)},
        )
        try:
            self._studies[fidelity].add_trial(trial)
        except (SQLAlchemyError, OptunaError) as error:
            _raise_full(error, self.path)
            raise

    def close(self) -> None:
        """Let go of the file."""
        _close(self._storage)


def key(values: Mapping[str, Any]) -> str:
    """The JSON of values, whatever their order."""
    return json.dumps(dict(values), sort_keys=True)


def _storage(path: Path) -> RDBStorage:
    # NullPool: a connection is closed after each use, also where opening the store fails
    engine = {"connect_args": {"timeout": 60}, "poolclass": NullPool}
    return RDBStorage(f"sqlite:///{path.absolute()}", engine_kwargs=engine)


def _close(storage: RDBStorage) -> None:
    storage.remove_session()
    storage.engine.dispose()


def _no_store(path: Path, error: BaseException) -> ParameterError:
    return ParameterError(f"store = {str(path)!r}: must be a file of talbot explore ({type(error).__name__})")


def _raise_full(error: BaseException | None, path: Path) -> None:
    """Raise OSError where a full disk is the reason of ``error``: SQLite has its own words."""
    while error:
        if "disk is full" in str(error):
            raise OSError(ENOSPC, strerror(ENOSPC), str(path)) from None
        error = error.__cause__ or error.__context__
