"""The report of a job: pictures of its motion, and one page that shows everything."""
