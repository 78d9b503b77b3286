"""Makes items of *.cases; fieldproof_pytest.py says how."""
pytest_plugins = ["fieldproof_pytest"]
