import matplotlib

matplotlib.use("agg")  # figures are drawn into memory; no test opens a window
