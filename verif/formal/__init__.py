"""Proofs by Yosys and SMT solvers of the properties in rtl/<block>/formal, each with a mutated twin that must fail."""
