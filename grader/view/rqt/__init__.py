"""`rqt`, `rqt_console` and `rqt_plot` for machines without Qt: pages in the browser."""
