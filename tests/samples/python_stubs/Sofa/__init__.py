"""A stand-in of SofaPython3 for the test of samples/sofa."""
