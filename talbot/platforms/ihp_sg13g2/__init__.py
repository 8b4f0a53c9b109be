"""IHP SG13G2, 130 nm BiCMOS, from the wheel `c4m-pdk-ihpsg13g2` (PDKMaster)."""
