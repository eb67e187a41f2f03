# For contributors; all stages, from nothing: .ci/run
.PHONY: check docs
check:  ## lint, types, and the tests that import what changed since main
	.ci/run lint types
	.venv/bin/python -m pytest -q -n auto --touched

docs:  ## the site, in docs/_build
	.venv/bin/pip install -q -e '.[docs]'
	.venv/bin/python -m sphinx -W -E -b html docs docs/_build
