from talbot.base.paths import BUILD, RESULTS, ROOT, build, results


def test_a_checkout_keeps_what_it_builds():
    assert BUILD == RESULTS == ROOT / "build"


def test_an_installation_uses_the_users_cache_and_the_working_directory(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert build(tmp_path / "site-packages") == tmp_path / "cache" / "talbot"
    assert not results(tmp_path / "site-packages").is_absolute()
