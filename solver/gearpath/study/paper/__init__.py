"""The paper's studies on its gearbox: every figure computed again, every statement judged by computed figures."""
