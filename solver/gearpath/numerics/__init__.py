"""Arrays only: solves across frequency lines, chunks, exact discretisation."""
