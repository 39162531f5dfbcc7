import matplotlib
from hypothesis import settings

# They need a browser and a minute or more: `make test-browser` names their folder, `make test`
# passes it by.
collect_ignore = ["browser"]

matplotlib.use("agg")  # figures are drawn into memory; no test opens a window

# The same examples in every run, and no time limit for one of them: the machine may be busy.
settings.register_profile("suite", deadline=None, derandomize=True)
settings.load_profile("suite")
